// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/PicturePrint.h>

#include <osgGeoFX/batch/OwnFolder.h>
#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/batch/detail/ContentHash.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/print/detail/TilePlan.h>
#include <osgGeoFX/raster/PictureFile.h>
#include <osgGeoFX/scene/DepthReader.h>

#include <lcms2.h>
#include <osg/Group>
#include <osg/Vec2d>

#include <algorithm>
#include <cctype>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

constexpr int smallestSide = 1, largestSide = 200000;
constexpr double millimetresPerInch = 25.4;
constexpr double usualDpi = 300.0;

class Fault : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// The tiles that are drawn, as files.
class TileFiles
{
public:
    TileFiles(fs::path folder, std::string key, PictureNumber number)
        : _folder(std::move(folder)), _key(std::move(key)), _number(number)
    {
        OwnFolder::take(_folder.string(), "folder");
    }

    fs::path pathOf(const PictureTile& tile) const
    {
        return _folder / ("tile-" + std::to_string(tile.row) + "-" + std::to_string(tile.column) + ".tif");
    }

    /// How many places of each name a tile shows; nothing where the tile is not there, or is one of another picture.
    std::optional<std::map<std::size_t, std::size_t>> seenIn(const PictureTile& tile) const
    {
        const auto input = PictureReader::open(pathOf(tile).string());
        if (!input) return std::nullopt;
        const PictureHeader& header = input->header();
        const auto description = header.attributes.find("ImageDescription");
        if (description == header.attributes.end()) return std::nullopt;
        std::istringstream text(std::get<std::string>(description->second));
        std::string key;
        if (!std::getline(text, key) || key != _key || header.width != tile.width ||
            header.height != tile.height || header.channels.size() != 3 || header.number != _number)
            return std::nullopt;
        std::map<std::size_t, std::size_t> seen;
        std::size_t name = 0, count = 0;
        while (text >> name >> count)
            seen[name] = count;
        return seen;
    }

    void write(const PictureTile& tile, const osg::Image& image, int tileHeight,
               const std::map<std::size_t, std::size_t>& seen) const
    {
        std::ostringstream description;
        description << _key << '\n';
        for (const auto& [name, count] : seen)
            description << name << ' ' << count << '\n';
        PictureHeader header;
        header.width = tile.width;
        header.height = tile.height;
        header.channels = {"R", "G", "B"};
        header.number = _number;
        header.set("ImageDescription", description.str());
        header.set("compression", "zip");
        header.set("tiff:zipquality", 1);
        const std::string unfinished = temporaryName(pathOf(tile).string());
        const auto output = PictureWriter::create("tiff");
        bool good = output && output->open(unfinished, header);
        // What a tile draws beyond the picture lies to the right and below.
        for (int row = 0; good && row < tile.height; ++row)
            good = output->write(image.data(0, static_cast<unsigned int>(tileHeight - 1 - row)), _number);
        good = output && output->close() && good;
        std::error_code fault;
        if (good) fs::rename(unfinished, pathOf(tile), fault);
        if (!good || fault)
            throw Fault("A tile cannot be written to \"" + _folder.string() +
                        "\"; check the folder, its permissions and the disk's space.");
    }

    const fs::path& folder() const { return _folder; }

    void remove() const { OwnFolder::remove(_folder.string()); }

private:
    const fs::path _folder;
    const std::string _key;
    const PictureNumber _number;
};

/// What tiles must have been drawn with to be used again; one line.
std::string keyOf(const PicturePrint::Options& options, const TilePlan& plan, const osg::Matrixd& view)
{
    std::ostringstream text;
    text.precision(17);
    text << options.recipe << '|' << plan.width << 'x' << plan.height << '|' << plan.tileWidth << 'x'
         << plan.tileHeight << '|' << options.renderer.fieldOfView << '|' << options.renderer.samples << '|';
    for (int i = 0; i < 16; ++i)
        text << view.ptr()[i] << ' ';
    if (options.names)
        for (const MapName& name : options.names->names())
        {
            text << name.text << ';';
            for (const osg::Vec3d& place : name.places)
                text << place.x() << ' ' << place.y() << ' ' << place.z() << ' ';
        }
    // The same on all machines that draw tiles of one print.
    const Digest digest = ContentHash().add(text.str()).digest();
    char key[48];
    std::snprintf(key, sizeof(key), "osgGeoFX %016" PRIx64 "%016" PRIx64, digest.high, digest.low);
    return key;
}

/// The light of an sRGB value of 16 bits, 0…1 (IEC 61966-2-1).
float lightOf(unsigned short code)
{
    const float value = static_cast<float>(code) / 65535.0f;
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/// The profile of sRGB as the International Color Consortium has it, the same at any time.
std::vector<unsigned char> colorProfile()
{
    const cmsHPROFILE profile = cmsCreate_sRGBProfile();
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile, nullptr, &size);
    std::vector<unsigned char> bytes(size);
    const bool good = size > 0 && cmsSaveProfileToMem(profile, bytes.data(), &size);
    cmsCloseProfile(profile);
    // The header has the hour at which it was made.
    constexpr std::ptrdiff_t date = 24, dateSize = 12;
    if (!good || bytes.size() < 128) return {};
    std::fill_n(bytes.begin() + date, dateSize, static_cast<unsigned char>(0));
    return bytes;
}

/// What tiles and pictures have in each channel.
PictureNumber numberOf(int bits)
{
    return bits > 8 ? PictureNumber::SHORT : PictureNumber::BYTE;
}

/// Whether the file's format has light and not its code.
bool isLinear(const std::string& file)
{
    const auto output = PictureWriter::create(file);
    return output && output->format() == "openexr";
}

/// A picture's file, written row by row. It is there when it is whole.
class PictureFile
{
public:
    /// `folder`: where the file is until then.
    PictureFile(const TilePlan& plan, const PicturePrint::Options& options, int bits, const std::string& file,
                const fs::path& folder)
        : _plan(plan), _whole(file),
          _unfinished(temporaryName((folder / _whole.filename()).string()) + _whole.extension().string()),
          _output(PictureWriter::create(file))
    {
        if (!_output)
            throw Fault("\"" + file +
                        "\": pictures of this kind cannot be written; use png, tif, jpg or exr.");
        _linear = isLinear(file);
        PictureHeader header;
        header.width = plan.width;
        header.height = plan.height;
        header.channels = {"R", "G", "B"};
        header.number = _linear ? PictureNumber::HALF : numberOf(bits);
        describe(header, options);
        if (!_output->open(_unfinished.string(), header)) throw fault();
        if (_output->has(header.number)) return;
        remove();
        throw Fault("\"" + file + "\": pictures of this kind have no " + std::to_string(bits) +
                    " bits for each channel; use png, tif or exr, or take 8 bits.");
    }

    ~PictureFile()
    {
        if (!_finished) remove();
    }
    PictureFile(const PictureFile&) = delete;
    PictureFile& operator=(const PictureFile&) = delete;

    /// The next row, whose values are the tiles' numbers.
    void write(const unsigned char* values, PictureNumber number)
    {
        const void* from = values;
        if (_linear)
        {
            _light.resize(3 * static_cast<std::size_t>(_plan.width));
            const auto* codes = reinterpret_cast<const unsigned short*>(values);
            std::transform(codes, codes + _light.size(), _light.begin(), lightOf);
            from = _light.data();
            number = PictureNumber::FLOAT;
        }
        if (!_output->write(from, number)) throw fault();
    }
    void finish()
    {
        if (!_output->close()) throw fault();
        std::error_code failure;
        fs::rename(_unfinished, _whole, failure);
        if (failure) throw fault();
        _finished = true;
    }

private:
    void describe(PictureHeader& header, const PicturePrint::Options& options) const
    {
        header.set("oiio:ColorSpace", _linear ? "Linear" : "sRGB");
        const std::vector<unsigned char> profile = _linear ? std::vector<unsigned char>() : colorProfile();
        if (!profile.empty()) header.set("ICCProfile", profile);
        header.set("compression", "zip");
        // Else it would have the hour at which it is written. No number is a date, so it has none.
        if (_output->format() == "tiff") header.set("DateTime", 0);
        if (header.bytes() > 3.9e9) header.set("tiff:bigtiff", 1);
        header.setDpi(options.size.dpi);
        for (const auto& [name, value] : options.metadata)
            header.set(name, value);
    }
    void remove()
    {
        if (!_output) return;
        _output.reset();
        std::error_code ignored;
        fs::remove(_unfinished, ignored);
    }
    Fault fault()
    {
        const std::string reason = _output->error();
        remove();
        return Fault("\"" + _whole.string() + "\" cannot be written (" + reason +
                     "); check the folder, its permissions, the disk's space, and whether the format has "
                     "pictures of this size.");
    }

    const TilePlan& _plan;
    const fs::path _whole, _unfinished;
    std::unique_ptr<PictureWriter> _output;
    bool _linear = false, _finished = false;
    std::vector<float> _light;
};

/// Puts the tiles of a row side by side. OSG's rows go upwards.
void readRow(const TilePlan& plan, const TileFiles& tiles, int row, PictureNumber number, osg::Image& strip)
{
    for (int column = 0; column < plan.columns; ++column)
    {
        const PictureTile tile = plan.at(column, row);
        const auto input = PictureReader::open(tiles.pathOf(tile).string());
        bool good = input && input->header().channels.size() == 3;
        for (int y = 0; good && y < tile.height; ++y)
            good = input->read(strip.data(static_cast<unsigned int>(tile.left),
                                          static_cast<unsigned int>(tile.height - 1 - y)),
                               number);
        if (!good)
            throw Fault("The tile \"" + tiles.pathOf(tile).string() +
                        "\" cannot be read any more; run it again.");
    }
}

/// Puts the tiles together. `bits`: of the tiles and of the file. `drawOver` draws over rows; the second number is the uppermost row's.
void assemble(const TilePlan& plan, const TileFiles& tiles, const PicturePrint::Options& options, int bits,
              const std::string& file, const std::function<void(osg::Image&, int)>& drawOver)
{
    PictureFile picture(plan, options, bits, file, tiles.folder());
    // Tiles are read as the file's numbers; those of 16 bits give one of 8, too.
    const PictureNumber number = numberOf(bits);
    const osg::ref_ptr<osg::Image> strip = new osg::Image;
    for (int row = 0; row < plan.rows; ++row)
    {
        const int top = plan.at(0, row).top, height = plan.at(0, row).height;
        strip->allocateImage(plan.width, height, 1, GL_RGB, bits > 8 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE);
        readRow(plan, tiles, row, number, *strip);
        drawOver(*strip, top);
        for (int y = 0; y < height; ++y)
            picture.write(strip->data(0, static_cast<unsigned int>(height - 1 - y)), number);
    }
    picture.finish();
}

} // namespace

struct PicturePrint::Parts
{
    Parts(Scene& itsScene, const Options& itsOptions, const osg::Matrixd& itsView, const std::string& file)
        : scene(itsScene), options(itsOptions), view(itsView),
          plan(options.size.width, options.size.height, options.tile),
          bits(options.bits > 8 || isLinear(file) ? 16 : 8),
          tiles(options.work, keyOf(options, plan, view), numberOf(bits)),
          depths(options.names ? scene.readDepths() : nullptr)
    {
    }

    PictureTile tile(int number) const { return plan.at(number % plan.columns, number / plan.columns); }
    /// The places of each name that a tile shows. It is drawn if it is not there.
    std::map<std::size_t, std::size_t> draw(const PictureTile& tile);
    /// What all tiles show of the names.
    std::optional<LabelPicture> place(const std::map<std::size_t, std::size_t>& seen);
    void write(const std::string& file);

    Scene& scene;
    const Options options;
    const osg::Matrixd view;
    const TilePlan plan;
    const int bits; ///< of the tiles and the file
    const TileFiles tiles;
    const osg::ref_ptr<DepthReader> depths;

private:
    void start();
    osg::ref_ptr<osg::Image> render();
    std::unique_ptr<SceneRenderer> _renderer; ///< null until a tile must be drawn
    std::vector<NameSet::Seen> _names;        ///< in the picture, once something is drawn
};

void PicturePrint::Parts::start()
{
    if (_renderer) return;
    SceneRenderer::Options drawing = options.renderer;
    drawing.width = plan.tileWidth;
    drawing.height = plan.tileHeight;
    drawing.pictureWidth = plan.width;
    drawing.pictureHeight = plan.height;
    drawing.format = bits > 8 ? ImageCapture::Format::Rgb16 : ImageCapture::Format::Rgb;
    std::string error;
    _renderer = SceneRenderer::create(scene, drawing, error);
    if (!_renderer) throw Fault(error);
}

osg::ref_ptr<osg::Image> PicturePrint::Parts::render()
{
    std::string error;
    FrameStatistics unused;
    osg::ref_ptr<osg::Image> image = _renderer->render(view, 0.0, unused, error);
    if (!image) throw Fault(error);
    if (options.names && _names.empty())
        _names = options.names->inPicture(*scene.effects, view, _renderer->camera().getProjectionMatrix(),
                                          plan.width, plan.height, LabelPicture::usualMost);
    return image;
}

std::map<std::size_t, std::size_t> PicturePrint::Parts::draw(const PictureTile& tile)
{
    if (const auto shown = tiles.seenIn(tile)) return *shown;
    start();
    _renderer->setTile(tile.left, plan.height - tile.top - plan.tileHeight);
    const osg::ref_ptr<osg::Image> image = render();
    std::map<std::size_t, std::size_t> shown;
    for (const NameSet::Seen& name : _names)
        if (const std::size_t count = NameSet::placesShown(name, depths->pictures()))
            shown[name.name] = count;
    tiles.write(tile, *image, plan.tileHeight, shown);
    return shown;
}

std::optional<LabelPicture> PicturePrint::Parts::place(const std::map<std::size_t, std::size_t>& seen)
{
    if (!options.names) return std::nullopt;
    if (!_renderer)
    {
        // All tiles were there. A small one tells the camera.
        start();
        render();
    }
    std::vector<bool> visible;
    for (const NameSet::Seen& name : _names)
    {
        const auto found = seen.find(name.name);
        visible.push_back(NameSet::isShown(name, found == seen.end() ? 0 : found->second));
    }
    return LabelPicture(*options.names, _names, visible, plan.width, plan.height);
}

void PicturePrint::Parts::write(const std::string& file)
{
    std::map<std::size_t, std::size_t> seen; // places of each name, in all tiles
    const int count = plan.columns * plan.rows;
    for (int number = 0; number < count; ++number)
    {
        for (const auto& [name, places] : draw(tile(number)))
            seen[name] += places;
        if (options.progress) options.progress(number + 1, count);
    }
    const std::optional<LabelPicture> labels = place(seen);
    if (labels && options.placed) options.placed(*labels);
    const auto drawOverlay = [&](osg::Image& rows, int top)
    {
        if (options.overlay) options.overlay(rows, top);
    };
    if (!options.plain.empty()) assemble(plan, tiles, options, 8, options.plain, drawOverlay);
    assemble(plan, tiles, options, bits, file,
             [&](osg::Image& rows, int top)
             {
                 if (!options.drawOver) return;
                 drawOverlay(rows, top);
                 if (labels) labels->drawOnto(rows, top);
             });
    tiles.remove();
}

namespace
{

/// A sheet of paper by its name, millimetres; landscape, or upright with "-portrait" behind the name. Empty: no known name.
std::optional<osg::Vec2d> sheetOf(const std::string& paper)
{
    const std::size_t dash = paper.find('-');
    const bool upright = dash != std::string::npos;
    if (upright && paper.substr(dash) != "-portrait") return std::nullopt;
    std::string name = paper.substr(0, dash);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char each) { return static_cast<char>(std::tolower(each)); });
    // ANSI/ASME Y14.1.
    static const std::map<std::string, osg::Vec2d> american = {
        {"letter", {279.4, 215.9}}, {"legal", {355.6, 215.9}}, {"tabloid", {431.8, 279.4}}};
    osg::Vec2d sheet;
    if (const auto found = american.find(name); found != american.end())
        sheet = found->second;
    else if (name.size() == 2 && name[0] == 'a' && name[1] >= '0' && name[1] <= '6')
    {
        // ISO 216: A0 has a square metre, and sides of 1 to the root of 2; the others are halves, rounded down to a millimetre.
        int wide = 1189, high = 841;
        for (int i = name[1] - '0'; i > 0; --i)
        {
            const int half = wide / 2;
            wide = high;
            high = half;
        }
        sheet.set(wide, high);
    }
    else
        return std::nullopt;
    return upright ? osg::Vec2d(sheet.y(), sheet.x()) : sheet;
}

} // namespace

std::optional<PrintSize> PrintSize::parse(const std::string& text, std::string& error)
{
    PrintSize size;
    std::string paper = text;
    const std::size_t at = text.find('@');
    if (at != std::string::npos)
    {
        paper = text.substr(0, at);
        int used = 0;
        const std::string resolution = text.substr(at + 1);
        if (std::sscanf(resolution.c_str(), "%lfdpi%n", &size.dpi, &used) != 1 ||
            static_cast<std::size_t>(used) != resolution.size() || !(size.dpi >= 1.0 && size.dpi <= 10000.0))
            size.dpi = -1.0;
    }
    double millimetresWide = 0.0, millimetresHigh = 0.0;
    int used = 0;
    char unit[3] = "";
    const auto whole = [&]
    {
        return used > 0 && static_cast<std::size_t>(used) == paper.size();
    };
    bool known = size.dpi >= 0.0;
    if (const std::optional<osg::Vec2d> sheet = known ? sheetOf(paper) : std::nullopt)
    {
        millimetresWide = sheet->x();
        millimetresHigh = sheet->y();
    }
    else if (known &&
             std::sscanf(paper.c_str(), "%lfx%lf%2[cmin]%n", &millimetresWide, &millimetresHigh, unit,
                         &used) == 3 &&
             whole() && (std::string(unit) == "cm" || std::string(unit) == "mm" || std::string(unit) == "in"))
    {
        const double length = std::string(unit) == "cm"   ? 10.0
                              : std::string(unit) == "mm" ? 1.0
                                                          : millimetresPerInch;
        millimetresWide *= length;
        millimetresHigh *= length;
    }
    else
    {
        used = 0;
        millimetresWide = millimetresHigh = 0.0;
        known = known && std::sscanf(paper.c_str(), "%9dx%9d%n", &size.width, &size.height, &used) == 2 &&
                whole();
    }
    if (known && millimetresWide > 0.0)
    {
        if (size.dpi <= 0.0) size.dpi = usualDpi;
        const auto pixels = [&](double millimetres)
        {
            return static_cast<int>(std::lround(std::min(millimetres / millimetresPerInch * size.dpi, 1e9)));
        };
        size.width = pixels(millimetresWide);
        size.height = pixels(millimetresHigh);
    }
    if (!known)
    {
        error = text +
                ": write a size such as 1600x900, A1@300dpi, A3-portrait@300dpi, Letter, Legal, Tabloid or "
                "90x60cm@200dpi.";
        return std::nullopt;
    }
    const int shorter = std::min(size.width, size.height), longer = std::max(size.width, size.height);
    if (shorter < smallestSide || longer > largestSide)
    {
        error = text + ": " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                " pixels cannot be had; each side may have " + std::to_string(smallestSide) + " to " +
                std::to_string(largestSide) + " pixels" +
                (size.dpi > 0.0 ? ", so take fewer for each inch." : ".");
        return std::nullopt;
    }
    return size;
}

PicturePrint::PicturePrint(std::unique_ptr<Parts> parts) : _parts(std::move(parts)) {}

PicturePrint::~PicturePrint() = default;

std::unique_ptr<PicturePrint> PicturePrint::create(Scene& scene, const Options& options,
                                                   const osg::Matrixd& view, const std::string& file,
                                                   std::string& error)
{
    try
    {
        return std::unique_ptr<PicturePrint>(
            new PicturePrint(std::make_unique<Parts>(scene, options, view, file)));
    }
    catch (const std::runtime_error& fault)
    {
        error = fault.what();
        return nullptr;
    }
}

int PicturePrint::countTiles(const Options& options)
{
    const TilePlan plan(options.size.width, options.size.height, options.tile);
    return plan.columns * plan.rows;
}

bool PicturePrint::isDrawn(int tile) const
{
    return _parts->tiles.seenIn(_parts->tile(tile)).has_value();
}

bool PicturePrint::draw(int tile, std::string& error)
{
    try
    {
        _parts->draw(_parts->tile(tile));
        return true;
    }
    catch (const std::runtime_error& fault)
    {
        error = fault.what();
        return false;
    }
}

bool PicturePrint::write(Scene& scene, const Options& options, const osg::Matrixd& view,
                         const std::string& file, std::string& error)
{
    try
    {
        Parts(scene, options, view, file).write(file);
        return true;
    }
    catch (const std::runtime_error& fault)
    {
        error = fault.what();
        return false;
    }
}

} // namespace osgGeoFX
