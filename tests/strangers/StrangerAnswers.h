// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What readers and programs make of awkward files, in words and numbers. README.md lists the questions.
#pragma once

#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/LandCoverTable.h>
#include <osgGeoFX/geodata/LineVectors.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/NameVectors.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/PalettePoints.h>
#include <osgGeoFX/geodata/RouteVectors.h>
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/SldColors.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <osgGeoFX/raster/ColorRampFile.h>
#include <strangers/StrangerFile.h>
#include <tools/KmlFiles.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_utils.h>
#include <ogrsf_frmts.h>

#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace geofx::test::strangers
{

using namespace osgGeoFX;
namespace fs = std::filesystem;

/// The answers of one case, whose files lie in a folder of their own.
class Answers
{
public:
    explicit Answers(std::vector<std::string>& messages) : _messages(messages) { GDALAllRegister(); }

    void write(const StrangerText& file) const
    {
        std::string text = file.text;
        for (const std::string& flag : file.flags)
        {
            if (flag == "crlf")
            {
                std::string lines;
                for (const char each : text)
                    lines += each == '\n' ? std::string("\r\n") : std::string(1, each);
                text = lines;
            }
            else if (flag == "bom")
                text = "\xEF\xBB\xBF" + text;
            else if (flag == "latin1")
            {
                char* const old = CPLRecode(text.c_str(), CPL_ENC_UTF8, "CP1252");
                text = old;
                CPLFree(old);
            }
            else if (flag == "utf16")
            {
                std::string wide = "\xFF\xFE";
                for (const char each : text)
                    wide += {each, '\0'};
                text = wide;
            }
            else if (flag == "gzip")
                text = "\x1f\x8b" + text; // its mark is enough to tell
            else if (beginsWith(flag, "cut="))
                text.resize(text.size() - std::stoul(flag.substr(4)));
            else
                throw std::runtime_error("no such flag of a file: " + flag);
        }
        _folder.write(file.name, text);
    }

    /// Throws std::runtime_error for a question that there is not, or something that cannot be made.
    std::string to(const std::vector<std::string>& words)
    {
        using Method = std::string (Answers::*)(const std::vector<std::string>&);
        static const std::map<std::string, Method> methods = {{"color", &Answers::color},
                                                              {"routes", &Answers::routes},
                                                              {"place", &Answers::place},
                                                              {"names", &Answers::names},
                                                              {"lines", &Answers::lines},
                                                              {"overlays", &Answers::overlays},
                                                              {"ground", &Answers::ground},
                                                              {"height", &Answers::height},
                                                              {"texture", &Answers::texture},
                                                              {"class", &Answers::classAt},
                                                              {"steps", &Answers::steps},
                                                              {"step", &Answers::step},
                                                              {"table", &Answers::table},
                                                              {"points", &Answers::points},
                                                              {"run", &Answers::run},
                                                              {"pixel", &Answers::pixel},
                                                              {"holds", &Answers::holds},
                                                              {"raster", &Answers::raster},
                                                              {"translate", &Answers::translate},
                                                              {"vectors", &Answers::vectors},
                                                              {"dimensions", &Answers::dimensions},
                                                              {"zip", &Answers::zip},
                                                              {"rename", &Answers::rename}};
        const auto method = methods.find(words[0]);
        if (method == methods.end()) throw std::runtime_error("there is no question \"" + words[0] + "\"");
        return plain((this->*method->second)({words.begin() + 1, words.end()}));
    }

    /// Without the folder's name, and on one line.
    std::string plain(std::string text) const
    {
        const std::string prefix = _folder.path().string();
        for (const std::string& part : {prefix + "/", prefix})
            for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at))
                text.erase(at, part.size());
        while (!text.empty() && text.back() == '\n')
            text.pop_back();
        return text;
    }

private:
    using Words = std::vector<std::string>;

    std::string path(const std::string& name) const { return (_folder / name).string(); }
    static std::string number(double value)
    {
        char text[40];
        std::snprintf(text, sizeof(text), "%.10g", value);
        return text;
    }
    static double numberOf(const std::string& text) { return std::stod(text); }
    static osg::Vec2d placeOf(const std::string& text)
    {
        const std::size_t comma = text.find(',');
        return {numberOf(text.substr(0, comma)), numberOf(text.substr(comma + 1))};
    }
    /// The value of NAME=VALUE among words; empty without one.
    static std::string option(const Words& words, const std::string& name)
    {
        for (const std::string& each : words)
            if (beginsWith(each, name + "=")) return each.substr(name.size() + 1);
        return {};
    }
    static std::string quoted(const std::string& text) { return "\"" + text + "\""; }
    static std::string listOf(const Words& parts)
    {
        std::string text;
        for (const std::string& each : parts)
            text += (text.empty() ? "" : " | ") + each;
        return text;
    }
    static std::string colorText(const osg::Vec4& color)
    {
        std::string text;
        for (int i = 0; i < 4; ++i)
            text += (i ? " " : "") + number(std::round(255.0 * static_cast<double>(color[i])));
        return text;
    }
    static std::string refusal(const std::string& error) { return "! " + error; }
    template<typename Work>
    static std::string caught(const Work& work)
    {
        try
        {
            return work();
        }
        catch (const BuildError& failure)
        {
            return refusal(failure.what());
        }
    }

    // Colors of values.

    osg::ref_ptr<ColorTable> tableOf(const std::string& name, std::string& error) const
    {
        return SldColors::isSld(path(name))
                   ? SldColors::read(path(name), error)
                   : ColorRampFile::read(path(name), ColorRampFile::Range(0.0, 100.0), error);
    }
    std::string color(const Words& words)
    {
        std::string error;
        const osg::ref_ptr<ColorTable> table = tableOf(words.at(0), error);
        return table ? colorText(table->at(numberOf(words.at(1)))) : refusal(error);
    }

    // Vector data.

    bool readRoutes(const Words& words, std::vector<RoutePath>& routes, std::string& error) const
    {
        return RouteVectors::read(path(words.at(0)), option(words, "layer"), routes, error);
    }
    std::string routes(const Words& words)
    {
        std::string error;
        std::vector<RoutePath> routes;
        if (!readRoutes(words, routes, error)) return refusal(error);
        Words parts;
        for (const RoutePath& each : routes)
            parts.push_back(quoted(each.name) + " " + std::to_string(each.places.size()) + " " +
                            std::array{"clamped", "above", "absolute"}[each.altitude]);
        return listOf(parts);
    }
    std::string place(const Words& words)
    {
        std::string error;
        std::vector<RoutePath> routes;
        if (!readRoutes(words, routes, error)) return refusal(error);
        const osg::Vec3d place = routes.at(std::stoul(words.at(1))).places.at(std::stoul(words.at(2)));
        return number(place.x()) + " " + number(place.y()) + " " + number(place.z());
    }
    std::string names(const Words& words)
    {
        std::string error;
        std::vector<MapName> names;
        NameVectors::Options options;
        options.layer = option(words, "layer");
        options.name = option(words, "field");
        if (!NameVectors::read(path(words.at(0)), options, {}, names, error)) return refusal(error);
        Words parts;
        for (const MapName& each : names)
        {
            std::string text = quoted(each.text);
            const osg::Vec3d& place = each.places.at(0);
            text += " " + number(place.x()) + " " + number(place.y());
            if (!std::isnan(place.z())) text += " " + number(place.z());
            if (!each.style.empty()) text += " " + each.style;
            if (each.kind == MapName::LINE) text += " (curve)";
            parts.push_back(text);
        }
        return listOf(parts);
    }
    std::string lines(const Words& words)
    {
        std::string error;
        std::vector<MapLine> lines;
        LineVectors::Options options;
        options.layer = option(words, "layer");
        options.style = option(words, "field");
        if (!LineVectors::read(path(words.at(0)), options, {}, lines, error)) return refusal(error);
        Words parts;
        for (const MapLine& each : lines)
            parts.push_back(quoted(each.name) + " " + (each.style.empty() ? "-" : each.style) + " " +
                            number(each.places.front().x()) + " " + number(each.places.front().y()));
        return listOf(parts);
    }

    // What lies on the ground.

    bool readGround(const Words& words, OverlayReader& reader, std::string& error)
    {
        if (const std::string crs = option(words, "plane"); !crs.empty())
        {
            OGRSpatialReference srs;
            if (srs.SetFromUserInput(crs.c_str()) != OGRERR_NONE) throw std::runtime_error(crs);
            char* text = nullptr;
            srs.exportToWkt(&text);
            reader.globe = false;
            reader.wkt = text;
            CPLFree(text);
        }
        OverlayReader::Options options;
        options.layer = option(words, "layer");
        if (const std::string file = option(words, "style"); !file.empty()) options.style = path(file);
        if (const std::string file = option(words, "colors"); !file.empty()) options.colors = path(file);
        const bool isRead = reader.read(path(words.at(0)), options, error);
        for (const std::string& each : reader.notices)
            _messages.push_back(each);
        return isRead;
    }
    std::string overlays(const Words& words)
    {
        std::string error;
        OverlayReader reader;
        if (!readGround(words, reader, error)) return refusal(error);
        Words parts;
        for (const GroundOverlay& each : reader.overlays)
        {
            std::string text = quoted(each.name);
            if (!each.visible) text += " hidden";
            if (each.symbol)
                text += " at " + number(each.symbol->longitude) + " " + number(each.symbol->latitude) +
                        (each.symbol->height ? " " + number(*each.symbol->height) : "");
            parts.push_back(text);
        }
        return listOf(parts);
    }
    std::string ground(const Words& words)
    {
        std::string error;
        OverlayReader reader;
        if (!readGround(words, reader, error)) return refusal(error);
        for (auto each = reader.overlays.rbegin(); each != reader.overlays.rend(); ++each)
        {
            if (!each->visible || each->symbol) continue;
            MappingFrame frame;
            frame.globe = reader.globe;
            frame.wkt = reader.wkt;
            frame.origin = reader.frames.at(each->frame);
            const auto place = OverlayRaster::placer(frame, words[0])(placeOf(words.at(1)));
            if (!place) continue;
            if (const std::string found = texelAt(*each, *place, error); !found.empty()) return found;
        }
        return "none";
    }
    /// Empty where the overlay has nothing.
    static std::string texelAt(const GroundOverlay& overlay, const osg::Vec2d& place, std::string& error)
    {
        osg::ref_ptr<const osg::Image> image = overlay.layer->getImage();
        double u = 0.5, v = 0.5;
        if (overlay.tiles)
        {
            const osg::Vec2d half(2.0, 2.0);
            image = overlay.tiles->read(place - half, place + half, 5, 5, error);
            if (!image) return refusal(error);
        }
        else
        {
            const glm::dvec3 uvw =
                overlay.makeMapping()->placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0);
            u = uvw.x / uvw.z;
            v = uvw.y / uvw.z;
            if (!(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0)) return {};
        }
        const unsigned char* const texel =
            image->data(static_cast<unsigned int>(u * image->s()), static_cast<unsigned int>(v * image->t()));
        if (overlay.layer->getKind() == DataLayer::COLOR)
        {
            if (texel[3] == 0) return {};
            osg::Vec4 color;
            for (unsigned int i = 0; i < 4; ++i)
                color[i] = static_cast<float>(texel[i]) / 255.0f;
            color.a() *= static_cast<float>(overlay.opacity);
            return colorText(color);
        }
        const auto value = static_cast<double>(*reinterpret_cast<const float*>(texel));
        if (std::isnan(value)) return {};
        return overlay.table ? colorText(overlay.table->at(value)) : number(value);
    }

    // What databases are built of.

    std::string height(const Words& words)
    {
        return caught(
            [&]
            {
                float value = std::numeric_limits<float>::quiet_NaN();
                RasterSource(path(words.at(0)), RasterKind::Elevation)
                    .sampleHeights(GridCrs::geocentric(), latticeAt(words.at(1)), &value);
                return std::isnan(value) ? std::string("none") : number(static_cast<double>(value));
            });
    }
    std::string texture(const Words& words)
    {
        return caught(
            [&]
            {
                std::array<unsigned char, 4> texel{};
                RasterSource(path(words.at(0)), RasterKind::Imagery)
                    .sampleColors(GridCrs::geocentric(), latticeAt(words.at(1)), texel.data());
                std::string text;
                for (const unsigned char each : texel)
                    text += (text.empty() ? "" : " ") + std::to_string(each);
                return texel[3] ? text : std::string("none");
            });
    }
    std::string classAt(const Words& words)
    {
        return caught(
            [&]
            {
                unsigned char value = 255;
                RasterSource(path(words.at(0)), RasterKind::LandCover)
                    .sampleClasses(GridCrs::geocentric(), latticeAt(words.at(1)), &value);
                return value == 255 ? std::string("none") : std::to_string(value);
            });
    }
    static Lattice latticeAt(const std::string& text)
    {
        const osg::Vec2d place = placeOf(text);
        return {place.x(), place.y(), 1e-6, 1e-6, 1, 1};
    }
    std::string table(const Words& words)
    {
        return caught(
            [&]
            {
                Words parts;
                for (const LandCoverClass& each : readLandCoverTable(path(words.at(0))))
                    parts.push_back(std::to_string(each.value) + " " + quoted(each.name) + " " +
                                    std::to_string(each.color[0]) + " " + std::to_string(each.color[1]) +
                                    " " + std::to_string(each.color[2]));
                return listOf(parts);
            });
    }

    /// Sample points of a painting: row of the palette and place of each.
    std::string points(const Words& words)
    {
        return caught(
            [&]
            {
                Words parts;
                for (const PalettePoint& each : readPalettePoints(path(words.at(0))))
                    parts.push_back(std::to_string(each.row) + " " + number(each.place.x()) + " " +
                                    number(each.place.y()));
                return listOf(parts);
            });
    }

    // Rasters in time.

    std::optional<SequenceRaster> openSequence(const Words& words, MappingFrame& frame, std::string& error)
    {
        const auto [file, variable] = SequenceRaster::parse(path(words.at(0)));
        SequenceRaster::Options options;
        options.variable = variable;
        return SequenceRaster::open(file, frame, true, options, error);
    }
    static std::string timeOf(const SequenceSteps& steps, double time)
    {
        return steps.dated() ? textOf(ClockTime{time, 0}) : number(time);
    }
    std::string steps(const Words& words)
    {
        std::string error;
        MappingFrame frame;
        const auto sequence = openSequence(words, frame, error);
        if (!sequence) return refusal(error);
        const std::vector<double>& times = sequence->steps->times();
        return std::to_string(times.size()) + " from " + timeOf(*sequence->steps, times.front()) + " to " +
               timeOf(*sequence->steps, times.back()) +
               (sequence->unit.empty() ? "" : " in " + sequence->unit);
    }
    std::string step(const Words& words)
    {
        std::string error;
        MappingFrame frame;
        const auto sequence = openSequence(words, frame, error);
        if (!sequence) return refusal(error);
        GroundOverlay overlay;
        overlay.layer = new DataLayer(sequence->steps->read(std::stoul(words.at(1)), error));
        if (!overlay.layer->getImage()) return refusal(error);
        overlay.layer->setKind(sequence->steps->kind());
        const osg::Vec2d& low = sequence->low;
        const osg::Vec2d& high = sequence->high;
        overlay.corners = {low, osg::Vec2d(high.x(), low.y()), high, osg::Vec2d(low.x(), high.y())};
        const auto place = OverlayRaster::placer(frame, words[0])(placeOf(words.at(2)));
        const std::string found = place ? texelAt(overlay, *place, error) : "";
        return found.empty() ? "none" : found;
    }

    // Programs.

    std::string run(const Words& words)
    {
        Words arguments = words;
        arguments[0] = builtProgram(words.at(0));
        ProgramOptions options;
        options.folder = _folder.path().string();
        const ProgramResult result = runProgram(arguments, options);
        for (const std::string& text : {result.standardOutput, result.standardError})
        {
            std::istringstream stream(text);
            for (std::string line; std::getline(stream, line);)
                if (!line.empty() && line.find(" % (") == std::string::npos)
                    _messages.push_back(line); // progress
        }
        return std::to_string(result.exitCode);
    }
    /// Of a picture: column and row from the upper left.
    std::string pixel(const Words& words)
    {
        const DatasetPtr picture(GDALDataset::Open(path(words.at(0)).c_str(), GDAL_OF_RASTER));
        if (!picture) return "! no picture";
        const osg::Vec2d place = placeOf(words.at(1));
        std::string text;
        for (int band = 1; band <= picture->GetRasterCount(); ++band)
        {
            double value = 0.0;
            if (picture->GetRasterBand(band)->RasterIO(GF_Read, static_cast<int>(place.x()),
                                                       static_cast<int>(place.y()), 1, 1, &value, 1, 1,
                                                       GDT_Float64, 0, 0, nullptr) != CE_None)
                return "! no pixel";
            text += (text.empty() ? "" : " ") + number(value);
        }
        return text;
    }
    /// Whether a file has these words.
    std::string holds(const Words& words)
    {
        if (!fs::exists(path(words.at(0)))) return "! no file";
        return bytesOf(path(words[0])).find(words.at(1)) == std::string::npos ? "no" : "yes";
    }

    // Files that are made.

    std::string raster(const Words& words)
    {
        const auto pair = [&](const char* name, const osg::Vec2d& otherwise)
        {
            std::string text = option(words, name);
            std::replace(text.begin(), text.end(), 'x', ',');
            return text.empty() || text == "none"        ? otherwise
                   : text.find(',') == std::string::npos ? osg::Vec2d(numberOf(text), numberOf(text))
                                                         : placeOf(text);
        };
        const osg::Vec2d size = pair("size", {20, 20}), from = pair("at", {10, 50}),
                         pixel = pair("pixel", {0.01, 0.01});
        const std::string bands = option(words, "bands"), type = option(words, "type"),
                          crs = option(words, "crs");
        TestRaster made(static_cast<int>(size.x()), static_cast<int>(size.y()),
                        bands.empty() ? 1 : std::stoi(bands),
                        type.empty() ? GDT_Float32 : GDALGetDataTypeByName(type.c_str()));
        if (crs != "none") made.crs(crs.empty() ? "EPSG:4326" : crs);
        if (option(words, "at") != "none") made.placed(from.x(), from.y(), pixel.x(), pixel.y());
        // The value is first + byColumn * column + byRow * row + byBand * band, all from 0.
        std::array<double, 4> fill{};
        std::istringstream numbers(option(words, "fill"));
        std::size_t count = 0;
        for (std::string each; count < 4 && std::getline(numbers, each, ',');)
            fill[count++] = numberOf(each);
        // One pixel may have a value of its own: column,row,value.
        std::array<double, 3> one{-1.0, -1.0, 0.0};
        std::istringstream odd(option(words, "one"));
        count = 0;
        for (std::string each; count < 3 && std::getline(odd, each, ',');)
            one[count++] = numberOf(each);
        made.fill(
            [&](int column, int row, int band)
            {
                return column == one[0] && row == one[1]
                           ? one[2]
                           : fill[0] + fill[1] * column + fill[2] * row + fill[3] * band;
            });
        for (int i = 1; i <= made.dataset().GetRasterCount(); ++i)
        {
            GDALRasterBand& band = *made.dataset().GetRasterBand(i);
            const auto set = [&](const char* name, const std::function<void(const std::string&)>& use)
            {
                std::istringstream stream(option(words, name));
                std::string each, last;
                for (int at = 1; std::getline(stream, each, ','); ++at)
                {
                    last = each;
                    if (at == i) break;
                }
                if (!last.empty()) use(last);
            };
            set("nodata", [&](const std::string& text) { band.SetNoDataValue(numberOf(text)); });
            set("unit", [&](const std::string& text) { band.SetUnitType(text.c_str()); });
            set("scale", [&](const std::string& text) { band.SetScale(numberOf(text)); });
            set("offset", [&](const std::string& text) { band.SetOffset(numberOf(text)); });
            set("interp", [&](const std::string& text)
                { band.SetColorInterpretation(GDALGetColorInterpretationByName(text.c_str())); });
            set("description", [&](const std::string& text) { band.SetDescription(text.c_str()); });
        }
        fs::create_directories(fs::path(path(words.at(0))).parent_path());
        made.write(path(words.at(0)));
        return {};
    }

    /// The two files of a conversion, and its options for GDAL.
    struct Conversion
    {
        std::string from, to;
        std::vector<char*> options;
    };
    Conversion conversion(const Words& words)
    {
        Conversion result{path(words.at(0)), path(words.at(1)), {}};
        for (auto each = words.begin() + 2; each != words.end(); ++each)
            result.options.push_back(const_cast<char*>(each->c_str()));
        result.options.push_back(nullptr);
        return result;
    }
    static void check(GDALDatasetH made)
    {
        if (!made) throw std::runtime_error(std::string("GDAL: ") + CPLGetLastErrorMsg());
        GDALClose(made);
    }
    std::string translate(const Words& words)
    {
        Conversion work = conversion(words);
        const DatasetPtr from(GDALDataset::Open(work.from.c_str(), GDAL_OF_RASTER));
        GDALTranslateOptions* const options = GDALTranslateOptionsNew(work.options.data(), nullptr);
        check(GDALTranslate(work.to.c_str(), from.get(), options, nullptr));
        GDALTranslateOptionsFree(options);
        return {};
    }
    std::string vectors(const Words& words)
    {
        // As ogr2ogr does, -oo is for opening.
        CPLStringList opening;
        Words others = words;
        for (auto each = others.begin(); each != others.end();)
        {
            if (*each != "-oo")
            {
                ++each;
                continue;
            }
            opening.AddString((each + 1)->c_str());
            each = others.erase(each, each + 2);
        }
        Conversion work = conversion(others);
        GDALDatasetH from = GDALDataset::ToHandle(
            GDALDataset::Open(work.from.c_str(), GDAL_OF_VECTOR, nullptr, opening.List()));
        GDALVectorTranslateOptions* const options =
            GDALVectorTranslateOptionsNew(work.options.data(), nullptr);
        check(GDALVectorTranslate(work.to.c_str(), nullptr, 1, &from, options, nullptr));
        GDALVectorTranslateOptionsFree(options);
        GDALClose(from);
        return {};
    }
    std::string dimensions(const Words& words)
    {
        Conversion work = conversion(words);
        GDALDatasetH from =
            GDALDataset::ToHandle(GDALDataset::Open(work.from.c_str(), GDAL_OF_MULTIDIM_RASTER));
        GDALMultiDimTranslateOptions* const options =
            GDALMultiDimTranslateOptionsNew(work.options.data(), nullptr);
        check(GDALMultiDimTranslate(work.to.c_str(), nullptr, 1, &from, options, nullptr));
        GDALMultiDimTranslateOptionsFree(options);
        GDALClose(from);
        return {};
    }
    /// An archive of files: their names within it, "=" and their own.
    std::string zip(const Words& words)
    {
        std::vector<std::pair<std::string, std::string>> entries;
        for (auto each = words.begin() + 1; each != words.end(); ++each)
        {
            const std::size_t at = each->find('=');
            entries.emplace_back(each->substr(0, at),
                                 bytesOf(path(at == std::string::npos ? *each : each->substr(at + 1))));
        }
        writeArchive(path(words.at(0)), entries);
        return {};
    }
    std::string rename(const Words& words)
    {
        fs::create_directories(fs::path(path(words.at(1))).parent_path());
        fs::rename(path(words.at(0)), path(words.at(1)));
        return {};
    }

    TempDir _folder;
    std::vector<std::string>& _messages;
};

} // namespace geofx::test::strangers
