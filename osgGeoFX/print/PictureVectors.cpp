// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/PictureVectors.h>

#include <osgGeoFX/batch/WholeFile.h>

#include <cairo-pdf.h>
#include <libxml/xmlwriter.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

constexpr double pointsPerInch = 72.0;
/// Sides of Cairo's surfaces.

std::string hexOf(const osg::Vec4& color)
{
    const auto byte = [](float value)
    {
        return static_cast<int>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    };
    char text[8];
    std::snprintf(text, sizeof(text), "#%02x%02x%02x", byte(color.r()), byte(color.g()), byte(color.b()));
    return text;
}

struct FreeWriter
{
    void operator()(xmlTextWriter* writer) const { xmlFreeTextWriter(writer); }
};

/// An XML file in the making.
class XmlFile
{
public:
    explicit XmlFile(const std::string& file) : _writer(xmlNewTextWriterFilename(file.c_str(), 0)) {}

    bool good() const { return _writer && _good; }
    void begin()
    {
        if (!_writer) return;
        xmlTextWriterSetIndent(_writer.get(), 1);
        check(xmlTextWriterStartDocument(_writer.get(), nullptr, "UTF-8", nullptr));
    }
    void open(const char* element)
    {
        check(_writer ? xmlTextWriterStartElement(_writer.get(), text(element)) : -1);
    }
    void close() { check(_writer ? xmlTextWriterEndElement(_writer.get()) : -1); }
    void set(const char* name, const std::string& value)
    {
        check(_writer ? xmlTextWriterWriteAttribute(_writer.get(), text(name), text(value.c_str())) : -1);
    }
    void set(const char* name, double value)
    {
        char number[32];
        std::snprintf(number, sizeof(number), "%.2f", value);
        set(name, std::string(number));
    }
    void write(const std::string& content)
    {
        check(_writer ? xmlTextWriterWriteString(_writer.get(), text(content.c_str())) : -1);
    }
    bool end()
    {
        check(_writer ? xmlTextWriterEndDocument(_writer.get()) : -1);
        return good();
    }

private:
    static const xmlChar* text(const char* value) { return reinterpret_cast<const xmlChar*>(value); }
    void check(int result) { _good = _good && result >= 0; }

    std::unique_ptr<xmlTextWriter, FreeWriter> _writer;
    bool _good = true;
};

/// A file that is there when all of it is written.
class Unfinished
{
public:
    explicit Unfinished(const std::string& file) : _file(file), _path(temporaryName(file)) {}
    ~Unfinished()
    {
        std::error_code ignored;
        fs::remove(_path, ignored);
    }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

    std::string path() const { return _path.string(); }
    bool finish(bool good, std::string& error)
    {
        std::error_code fault;
        if (good) fs::rename(_path, _file, fault);
        if (good && !fault) return true;
        error =
            "\"" + _file + "\" cannot be written; check the folder, its permissions and the disk's space.";
        return false;
    }

private:
    const std::string _file;
    const fs::path _path;
};

/// A path's text. `down`: how far below the points, pixels.
std::string wayOf(const std::vector<osg::Vec2d>& points, double height, double down = 0.0)
{
    std::string way;
    for (const osg::Vec2d& point : points)
    {
        char pair[64];
        std::snprintf(pair, sizeof(pair), "%c%.2f %.2f", way.empty() ? 'M' : 'L', point.x(),
                      height - point.y() + down);
        way += pair;
    }
    return way;
}

void writeLines(const LinePicture& lines, XmlFile& svg)
{
    for (const bool casing : {true, false})
    {
        for (const LinePicture::Part& part : lines.parts())
        {
            const MapLine& line = lines.lines()[part.line];
            const LineStyle& style = lines.styleOf(part);
            if (casing && style.casingWidth <= 0.0) continue;
            svg.open("g");
            svg.set("class", (casing ? "casing " : "line ") + line.style);
            svg.set("fill", std::string("none"));
            svg.set("stroke", hexOf(casing ? style.casing : style.color));
            svg.set("stroke-opacity", static_cast<double>((casing ? style.casing : style.color).a()));
            svg.set("stroke-linejoin", std::string("round"));
            if (!line.name.empty() && !casing)
            {
                svg.open("title");
                svg.write(line.name);
                svg.close();
            }
            for (const LinePicture::Piece& piece : lines.piecesOf(part))
            {
                const bool dashes = !casing && piece.dash > 0.0 && piece.gap > 0.0;
                svg.open("path");
                svg.set("d", wayOf(piece.points, lines.height()));
                svg.set("stroke-width",
                        piece.width + (casing ? 2.0 * lines.scale() * style.casingWidth : 0.0));
                svg.set("stroke-linecap", std::string(dashes ? "butt" : "round"));
                if (dashes)
                {
                    char text[80];
                    std::snprintf(text, sizeof(text), "%.2f %.2f", piece.dash, piece.gap);
                    svg.set("stroke-dasharray", std::string(text));
                    svg.set("stroke-dashoffset", piece.offset);
                }
                svg.close();
            }
            svg.close();
        }
    }
}

void writeMark(const LabelPicture::Name& each, const NameStyle& style, double scale, double height,
               XmlFile& svg)
{
    if (each.label.leader)
    {
        svg.open("line");
        svg.set("x1", each.label.anchor.x());
        svg.set("y1", height - each.label.anchor.y());
        svg.set("x2", each.label.anchor.x());
        svg.set("y2", height - each.label.corner.y());
        svg.set("stroke", hexOf(style.text.color));
        svg.set("stroke-width", scale * style.lineWidth);
        svg.close();
    }
    if (style.dot > 0.0)
    {
        svg.open("circle");
        svg.set("cx", each.label.anchor.x());
        svg.set("cy", height - each.label.anchor.y());
        svg.set("r", scale * style.dot);
        svg.set("fill", hexOf(style.text.color));
        svg.close();
    }
}

void writeFont(const NameStyle& style, double scale, XmlFile& svg)
{
    svg.set("font-family", style.text.font);
    svg.set("font-size", scale * style.text.size);
    if (style.text.bold) svg.set("font-weight", std::string("bold"));
    if (style.text.italic) svg.set("font-style", std::string("italic"));
    if (style.text.spacing > 0.0) svg.set("letter-spacing", scale * style.text.size * style.text.spacing);
    svg.set("fill", hexOf(style.text.color));
    if (style.text.haloWidth > 0.0)
    {
        svg.set("stroke", hexOf(style.text.halo));
        svg.set("stroke-opacity", static_cast<double>(style.text.halo.a()));
        svg.set("stroke-width", 2.0 * scale * style.text.size * style.text.haloWidth);
        svg.set("stroke-linejoin", std::string("round"));
        svg.set("paint-order", std::string("stroke"));
    }
}

void writeNames(const LabelPicture& names, XmlFile& svg)
{
    NameSet& set = names.names();
    const double scale = set.getScale(), height = names.height();
    int curves = 0;
    for (const LabelPicture::Name& each : names.placed())
    {
        const MapName& name = set.names()[each.name];
        const NameStyle& style = set.styleOf(name);
        const LabelText& text = set.text(each.name);
        svg.open("g");
        svg.set("class", name.style.empty() ? std::string("name") : name.style);
        writeMark(each, style, scale, height, svg);
        std::string path;
        if (!each.curve.empty())
        {
            path = "curve" + std::to_string(++curves);
            svg.open("path");
            svg.set("id", path);
            svg.set("d", wayOf(each.curve, height, 0.25 * scale * style.text.size));
            svg.set("fill", std::string("none"));
            svg.close();
        }
        svg.open("text");
        writeFont(style, scale, svg);
        if (path.empty())
        {
            svg.set("x", each.label.corner.x() + text.left());
            svg.set("y", height - (each.label.corner.y() + each.label.size.y()) + text.above());
            svg.write(name.text);
        }
        else
        {
            svg.set("text-anchor", std::string("middle"));
            svg.open("textPath");
            svg.set("xlink:href", "#" + path);
            svg.set("startOffset", std::string("50%"));
            svg.write(name.text);
            svg.close();
        }
        svg.close();
        svg.close();
    }
}

/// GeoJSON's coordinates of a pixel.
nlohmann::json placeOf(const osg::Vec2d& pixel, double height)
{
    const auto rounded = [](double value)
    {
        return std::round(100.0 * value) / 100.0;
    };
    return {rounded(pixel.x()), rounded(pixel.y() - height)};
}

nlohmann::json placesOf(const std::vector<osg::Vec2d>& points, double height)
{
    nlohmann::json places = nlohmann::json::array();
    for (const osg::Vec2d& point : points)
        places.push_back(placeOf(point, height));
    return places;
}

nlohmann::json featureOf(const char* type, const nlohmann::json& places, const nlohmann::json& properties)
{
    return {{"type", "Feature"},
            {"geometry", {{"type", type}, {"coordinates", places}}},
            {"properties", properties}};
}

} // namespace

bool PictureVectors::writeSvg(const std::string& file, const std::string& picture, std::string& error) const
{
    Unfinished unfinished(file);
    bool good = false;
    {
        XmlFile svg(unfinished.path());
        svg.begin();
        svg.open("svg");
        svg.set("xmlns", std::string("http://www.w3.org/2000/svg"));
        svg.set("xmlns:xlink", std::string("http://www.w3.org/1999/xlink"));
        svg.set("width", width);
        svg.set("height", height);
        svg.set("viewBox", "0 0 " + std::to_string(static_cast<int>(width)) + " " +
                               std::to_string(static_cast<int>(height)));
        if (!picture.empty())
        {
            svg.open("image");
            svg.set("xlink:href", picture);
            svg.set("width", width);
            svg.set("height", height);
            svg.close();
        }
        if (lines) writeLines(*lines, svg);
        if (names) writeNames(*names, svg);
        svg.close();
        good = svg.end();
    }
    return unfinished.finish(good, error);
}

bool PictureVectors::writePdf(const std::string& file, const std::string& picture, double dpi,
                              const std::string& title, std::string& error) const
{
    if (width > largestPdfSide || height > largestPdfSide)
    {
        error = "\"" + file + "\" cannot be written: pages of a PDF have up to " +
                std::to_string(largestPdfSide) +
                " pixels on a side; take fewer for each inch, or write a TIFF.";
        return false;
    }
    std::ifstream stream(picture, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : 0;
    // Cairo frees it.
    auto* const bytes =
        static_cast<unsigned char*>(std::malloc(static_cast<std::size_t>(std::max<std::streamoff>(size, 1))));
    stream.seekg(0);
    if (size == 0 || !bytes || !stream.read(reinterpret_cast<char*>(bytes), size))
    {
        std::free(bytes);
        error = "\"" + picture + "\" cannot be read; check its name.";
        return false;
    }
    Unfinished unfinished(file);
    const double points = pointsPerInch / dpi;
    cairo_surface_t* const page =
        cairo_pdf_surface_create(unfinished.path().c_str(), width * points, height * points);
    cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_CREATOR, "osgGeoFX");
    // No date; else it would have the hour at which it is written.
    cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_CREATE_DATE, "");
    cairo_t* const target = cairo_create(page);
    cairo_scale(target, points, points);
    // Its pixels are not used, since the JPEG stands for them; so they are single bits.
    cairo_surface_t* const raster =
        cairo_image_surface_create(CAIRO_FORMAT_A1, static_cast<int>(width), static_cast<int>(height));
    cairo_surface_set_mime_data(raster, CAIRO_MIME_TYPE_JPEG, bytes, static_cast<unsigned long>(size),
                                std::free, bytes);
    cairo_set_source_surface(target, raster, 0.0, 0.0);
    cairo_paint(target);
    if (lines) lines->draw(target);
    if (names) names->draw(target);
    cairo_show_page(target);
    const bool drawn = cairo_status(target) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(target);
    cairo_surface_destroy(raster);
    cairo_surface_finish(page);
    const bool written = cairo_surface_status(page) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(page);
    return unfinished.finish(drawn && written, error);
}

bool PictureVectors::writeGeoJson(const std::string& file, std::string& error) const
{
    nlohmann::json features = nlohmann::json::array();
    for (std::size_t i = 0; lines && i < lines->parts().size(); ++i)
    {
        const LinePicture::Part& part = lines->parts()[i];
        const MapLine& line = lines->lines()[part.line];
        const std::vector<LinePicture::Piece> pieces = lines->piecesOf(part);
        features.push_back(
            featureOf("LineString", placesOf(part.points, height),
                      {{"name", line.name}, {"style", line.style}, {"width", pieces.front().width}}));
    }
    for (std::size_t i = 0; names && i < names->placed().size(); ++i)
    {
        const LabelPicture::Name& each = names->placed()[i];
        const MapName& name = names->names().names()[each.name];
        nlohmann::json properties = {{"name", name.text}, {"style", name.style}};
        if (!std::isnan(name.importance)) properties["importance"] = name.importance;
        if (!each.curve.empty()) properties["curve"] = placesOf(each.curve, height);
        features.push_back(featureOf("Point", placeOf(each.label.anchor, height), properties));
    }
    Unfinished unfinished(file);
    std::ofstream stream(unfinished.path());
    stream << nlohmann::json{{"type", "FeatureCollection"}, {"features", features}}.dump(
                  1, ' ', false, nlohmann::json::error_handler_t::replace)
           << '\n';
    stream.close();
    return unfinished.finish(stream.good(), error);
}

} // namespace osgGeoFX
