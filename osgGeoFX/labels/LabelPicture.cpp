// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/LabelPicture.h>

#include <cairo.h>
#include <libxml/xmlwriter.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace osgGeoFX
{

namespace
{

void setColor(cairo_t* target, const osg::Vec4& color)
{
    cairo_set_source_rgba(target, static_cast<double>(color.r()), static_cast<double>(color.g()),
                          static_cast<double>(color.b()), static_cast<double>(color.a()));
}

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

} // namespace

LabelPicture::LabelPicture(NameSet& names, EffectScene& scene, const osg::Camera& camera,
                           const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                           const LabelLayout::Rules& rules, std::size_t most)
    : _names(&names), _width(camera.getViewport()->width()), _height(camera.getViewport()->height())
{
    const std::vector<NameSet::Seen> seen =
        names.inPicture(DeformedView(scene, camera), _width, _height, most);
    std::vector<bool> visible;
    for (const NameSet::Seen& each : seen)
        visible.push_back(depths.empty() || NameSet::isShown(each, NameSet::placesShown(each, depths)));
    place(seen, visible, rules);
}

LabelPicture::LabelPicture(NameSet& names, const std::vector<NameSet::Seen>& seen,
                           const std::vector<bool>& visible, double width, double height,
                           const LabelLayout::Rules& rules)
    : _names(&names), _width(width), _height(height)
{
    place(seen, visible, rules);
}

void LabelPicture::place(const std::vector<NameSet::Seen>& seen, const std::vector<bool>& visible,
                         const LabelLayout::Rules& rules)
{
    std::vector<LabelCandidate> candidates;
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
        candidates.push_back(seen[i].label);
        candidates.back().id = i;
        candidates.back().visible = i < visible.size() && visible[i];
    }
    LabelLayout::Rules scaled = rules;
    scaled.gap *= _names->getScale();
    scaled.room *= _names->getScale();
    for (const PlacedLabel& label : LabelLayout::placeOnce(candidates, _width, _height, scaled))
    {
        _placed.push_back({seen[label.id].name, label, seen[label.id].label.curve});
        _placed.back().label.id = seen[label.id].name;
    }
}

void LabelPicture::draw(_cairo* target) const
{
    const double scale = _names->getScale();
    for (const Name& each : _placed)
    {
        const NameStyle& style = _names->styleOf(_names->names()[each.name]);
        const double x = each.label.anchor.x(), y = _height - each.label.anchor.y();
        for (const bool halo : {true, false})
        {
            setColor(target, halo ? style.text.halo : style.text.color);
            cairo_set_line_width(target, scale * style.lineWidth * (halo ? 2.0 : 1.0));
            cairo_set_line_cap(target, CAIRO_LINE_CAP_BUTT);
            if (each.label.leader)
            {
                cairo_move_to(target, x, y);
                cairo_line_to(target, x, _height - each.label.corner.y());
                cairo_stroke(target);
            }
            if (style.dot > 0.0)
            {
                cairo_new_sub_path(target);
                cairo_arc(target, x, y, scale * (style.dot + (halo ? 0.5 * style.lineWidth : 0.0)), 0.0,
                          2.0 * M_PI);
                cairo_fill(target);
            }
        }
    }
    for (const Name& each : _placed)
    {
        const LabelText& text = _names->text(each.name);
        if (each.curve.empty())
        {
            text.draw(target, each.label.corner.x() + text.left(),
                      _height - (each.label.corner.y() + each.label.size.y()) + text.above());
            continue;
        }
        std::vector<osg::Vec2d> curve;
        for (const osg::Vec2d& point : each.curve)
            curve.emplace_back(point.x(), _height - point.y());
        text.drawAlong(target, curve);
    }
}

bool LabelPicture::drawOnto(osg::Image& image) const
{
    return image.t() == static_cast<int>(_height) && drawOnto(image, 0);
}

bool LabelPicture::drawOnto(osg::Image& image, int first) const
{
    const int channels = image.getPixelFormat() == GL_RGB ? 3 : image.getPixelFormat() == GL_RGBA ? 4 : 0;
    if (!channels || image.getDataType() != GL_UNSIGNED_BYTE || image.s() != static_cast<int>(_width))
        return false;
    // In parts, so that large pictures need no second one.
    constexpr int strip = 512;
    for (int top = 0; top < image.t(); top += strip)
    {
        const int rows = std::min(strip, image.t() - top);
        cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.s(), rows);
        cairo_t* const target = cairo_create(surface);
        cairo_translate(target, 0.0, -(first + top));
        draw(target);
        cairo_destroy(target);
        cairo_surface_flush(surface);
        for (int row = 0; row < rows; ++row)
        {
            const unsigned char* const from =
                cairo_image_surface_get_data(surface) + row * cairo_image_surface_get_stride(surface);
            unsigned char* const to = image.data(0, static_cast<unsigned int>(image.t() - 1 - (top + row)));
            for (int x = 0; x < image.s(); ++x)
            {
                std::uint32_t pixel = 0;
                std::memcpy(&pixel, from + 4 * x, 4);
                const unsigned int alpha = pixel >> 24;
                if (alpha == 0) continue;
                unsigned char* const here = to + channels * x;
                const unsigned int over[3] = {(pixel >> 16) & 255u, (pixel >> 8) & 255u, pixel & 255u};
                for (int channel = 0; channel < 3; ++channel)
                    here[channel] = static_cast<unsigned char>(
                        std::min(255u, over[channel] + (here[channel] * (255u - alpha) + 127u) / 255u));
                if (channels == 4)
                    here[3] = static_cast<unsigned char>(alpha + (here[3] * (255u - alpha) + 127u) / 255u);
            }
        }
        cairo_surface_destroy(surface);
    }
    return true;
}

bool LabelPicture::writeSvg(const std::string& file, const std::string& picture, std::string& error) const
{
    const double scale = _names->getScale();
    XmlFile svg(file);
    svg.begin();
    svg.open("svg");
    svg.set("xmlns", std::string("http://www.w3.org/2000/svg"));
    svg.set("xmlns:xlink", std::string("http://www.w3.org/1999/xlink"));
    svg.set("width", _width);
    svg.set("height", _height);
    svg.set("viewBox", "0 0 " + std::to_string(static_cast<int>(_width)) + " " +
                           std::to_string(static_cast<int>(_height)));
    if (!picture.empty())
    {
        svg.open("image");
        svg.set("xlink:href", picture);
        svg.set("width", _width);
        svg.set("height", _height);
        svg.close();
    }
    int curves = 0;
    for (const Name& each : _placed)
    {
        const MapName& name = _names->names()[each.name];
        const NameStyle& style = _names->styleOf(name);
        const LabelText& text = _names->text(each.name);
        svg.open("g");
        svg.set("class", name.style.empty() ? std::string("name") : name.style);
        if (each.label.leader)
        {
            svg.open("line");
            svg.set("x1", each.label.anchor.x());
            svg.set("y1", _height - each.label.anchor.y());
            svg.set("x2", each.label.anchor.x());
            svg.set("y2", _height - each.label.corner.y());
            svg.set("stroke", hexOf(style.text.color));
            svg.set("stroke-width", scale * style.lineWidth);
            svg.close();
        }
        if (style.dot > 0.0)
        {
            svg.open("circle");
            svg.set("cx", each.label.anchor.x());
            svg.set("cy", _height - each.label.anchor.y());
            svg.set("r", scale * style.dot);
            svg.set("fill", hexOf(style.text.color));
            svg.close();
        }
        std::string path;
        if (!each.curve.empty())
        {
            path = "curve" + std::to_string(++curves);
            std::string way;
            for (const osg::Vec2d& point : each.curve)
            {
                char pair[64];
                std::snprintf(pair, sizeof(pair), "%c%.2f %.2f", way.empty() ? 'M' : 'L', point.x(),
                              _height - point.y() + 0.25 * scale * style.text.size);
                way += pair;
            }
            svg.open("path");
            svg.set("id", path);
            svg.set("d", way);
            svg.set("fill", std::string("none"));
            svg.close();
        }
        svg.open("text");
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
        if (path.empty())
        {
            svg.set("x", each.label.corner.x() + text.left());
            svg.set("y", _height - (each.label.corner.y() + each.label.size.y()) + text.above());
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
    svg.close();
    if (svg.end()) return true;
    error = "\"" + file + "\" cannot be written; check the folder, its permissions and the disk's space.";
    return false;
}

} // namespace osgGeoFX
