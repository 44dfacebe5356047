// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/LabelText.h>

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgGeoFX
{

namespace
{

struct FreeObject
{
    void operator()(void* object) const { g_object_unref(object); }
};

/// `most`: letters.
std::string cleaned(const std::string& text, long most)
{
    gchar* const valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
    const bool longer = g_utf8_strlen(valid, -1) > most;
    std::string result(valid, longer ? g_utf8_offset_to_pointer(valid, most) : valid + std::strlen(valid));
    g_free(valid);
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return result;
}

/// A curve by the length along it.
class Ruler
{
public:
    explicit Ruler(const std::vector<osg::Vec2d>& points) : _points(points)
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            _along.push_back(i == 0 ? 0.0 : _along.back() + (points[i] - points[i - 1]).length());
    }

    double length() const { return _along.empty() ? 0.0 : _along.back(); }

    /// The place beside the curve; `beside` points to the right of the way, which is down for a way to the right.
    osg::Vec2d at(double along, double beside) const
    {
        const auto next = std::upper_bound(_along.begin() + 1, _along.end() - 1, along);
        const auto i = static_cast<std::size_t>(next - _along.begin());
        const double share = (along - _along[i - 1]) / std::max(_along[i] - _along[i - 1], 1e-12);
        const osg::Vec2d place = _points[i - 1] + (_points[i] - _points[i - 1]) * share;
        // The direction turns from segment to segment, so letters bend and do not break.
        osg::Vec2d way = direction(i, share);
        return place + osg::Vec2d(-way.y(), way.x()) * beside;
    }

private:
    osg::Vec2d segment(std::size_t i) const
    {
        osg::Vec2d way = _points[i] - _points[i - 1];
        way.normalize();
        return way;
    }
    osg::Vec2d direction(std::size_t i, double share) const
    {
        const osg::Vec2d here = segment(i);
        const osg::Vec2d other =
            share < 0.5 ? (i > 1 ? segment(i - 1) : here) : (i + 1 < _points.size() ? segment(i + 1) : here);
        osg::Vec2d way = here * (1.0 - std::abs(share - 0.5)) + other * std::abs(share - 0.5);
        way.normalize();
        return way;
    }

    const std::vector<osg::Vec2d>& _points;
    std::vector<double> _along;
};

} // namespace

struct LabelText::Layout
{
    LabelStyle style;
    std::unique_ptr<PangoLayout, FreeObject> layout;
    PangoRectangle ink = {};
    PangoRectangle logical = {};

    PangoLayoutLine* line() const { return pango_layout_get_line_readonly(layout.get(), 0); }
    double halo() const { return style.haloWidth * style.size; }

    /// Paints the path of the letters, halo first.
    void paint(cairo_t* target) const
    {
        paintHalo(target);
        setColor(target, style.color);
        cairo_fill(target);
    }

    /// Leaves the path as it is.
    void paintHalo(cairo_t* target) const
    {
        if (style.haloWidth > 0.0 && style.halo.a() > 0.0f)
        {
            cairo_set_line_join(target, CAIRO_LINE_JOIN_ROUND);
            cairo_set_line_cap(target, CAIRO_LINE_CAP_ROUND);
            cairo_set_line_width(target, 2.0 * halo());
            setColor(target, style.halo);
            cairo_stroke_preserve(target);
        }
    }

    static void setColor(cairo_t* target, const osg::Vec4& color)
    {
        cairo_set_source_rgba(target, static_cast<double>(color.r()), static_cast<double>(color.g()),
                              static_cast<double>(color.b()), static_cast<double>(color.a()));
    }
};

LabelText::LabelText(const std::string& text, const LabelStyle& style) : _layout(std::make_unique<Layout>())
{
    _layout->style = style;
    // The default map is the thread's own.
    const std::unique_ptr<PangoContext, FreeObject> context(
        pango_font_map_create_context(pango_cairo_font_map_get_default()));
    // A hint moves letters to whole pixels of a size that another picture does not have.
    cairo_font_options_t* const options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context.get(), options);
    cairo_font_options_destroy(options);
    pango_cairo_context_set_resolution(context.get(), 72.0);
    pango_context_set_round_glyph_positions(context.get(), FALSE);

    PangoLayout* const layout = pango_layout_new(context.get());
    _layout->layout.reset(layout);
    PangoFontDescription* const font = pango_font_description_new();
    pango_font_description_set_family(font, style.font.c_str());
    pango_font_description_set_weight(font, style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_style(font, style.italic ? PANGO_STYLE_ITALIC : PANGO_STYLE_NORMAL);
    pango_font_description_set_absolute_size(font, std::clamp(style.size, 1.0, 2000.0) * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    // Letters behind the ellipsis would be laid out, too. Few are narrower than an eighth of the size.
    const std::string clean =
        cleaned(text, 16 + static_cast<long>(8.0 * std::clamp(style.longest, 1.0, 1e4)));
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    pango_layout_set_text(layout, clean.data(), static_cast<int>(clean.size()));
    if (style.spacing > 0.0)
    {
        PangoAttrList* const attributes = pango_attr_list_new();
        pango_attr_list_insert(attributes, pango_attr_letter_spacing_new(static_cast<int>(
                                               std::min(style.spacing, 4.0) * style.size * PANGO_SCALE)));
        pango_layout_set_attributes(layout, attributes);
        pango_attr_list_unref(attributes);
    }
    pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_END);
    pango_layout_set_width(layout, static_cast<int>(std::max(style.longest, 1.0) * style.size * PANGO_SCALE));
    pango_layout_line_get_extents(_layout->line(), &_layout->ink, &_layout->logical);
}

LabelText::~LabelText() = default;
LabelText::LabelText(LabelText&&) noexcept = default;
LabelText& LabelText::operator=(LabelText&&) noexcept = default;

double LabelText::width() const
{
    if (_layout->ink.width <= 0) return 0.0;
    return static_cast<double>(_layout->ink.width) / PANGO_SCALE + 2.0 * _layout->halo();
}

double LabelText::height() const
{
    if (_layout->ink.width <= 0) return 0.0;
    return static_cast<double>(_layout->ink.height) / PANGO_SCALE + 2.0 * _layout->halo();
}

double LabelText::above() const
{
    if (_layout->ink.width <= 0) return 0.0;
    return static_cast<double>(-_layout->ink.y) / PANGO_SCALE + _layout->halo();
}

double LabelText::left() const
{
    if (_layout->ink.width <= 0) return 0.0;
    return static_cast<double>(-_layout->ink.x) / PANGO_SCALE + _layout->halo();
}

bool LabelText::isCut() const
{
    return pango_layout_is_ellipsized(_layout->layout.get());
}

int LabelText::missingLetters() const
{
    return pango_layout_get_unknown_glyphs_count(_layout->layout.get());
}

void LabelText::draw(_cairo* target, double x, double y) const
{
    if (_layout->ink.width <= 0) return;
    cairo_save(target);
    cairo_translate(target, x, y);
    cairo_new_path(target);
    pango_cairo_layout_line_path(target, _layout->line());
    if (cairo_surface_get_type(cairo_get_target(target)) == CAIRO_SURFACE_TYPE_PDF)
    {
        // As letters, which people search and copy.
        _layout->paintHalo(target);
        cairo_new_path(target);
        Layout::setColor(target, _layout->style.color);
        pango_cairo_show_layout_line(target, _layout->line());
    }
    else
        _layout->paint(target);
    cairo_restore(target);
}

bool LabelText::drawAlong(_cairo* target, const std::vector<osg::Vec2d>& curve) const
{
    if (_layout->ink.width <= 0 || curve.size() < 2) return false;
    const Ruler ruler(curve);
    const double inkWidth = static_cast<double>(_layout->ink.width) / PANGO_SCALE;
    if (!(ruler.length() >= inkWidth)) return false;
    const double start =
        0.5 * (ruler.length() - inkWidth) - static_cast<double>(_layout->ink.x) / PANGO_SCALE;
    // The middle of low letters lies on the curve.
    const double lower = 0.25 * _layout->style.size;
    cairo_save(target);
    // Cairo gives no path of glyphs that lie outside of the surface, and before they are bent they may.
    cairo_save(target);
    cairo_identity_matrix(target);
    cairo_new_path(target);
    cairo_move_to(target, 0.0, above());
    pango_cairo_layout_line_path(target, _layout->line());
    cairo_set_tolerance(target, 0.02);
    cairo_path_t* const path = cairo_copy_path_flat(target);
    cairo_restore(target);
    for (int i = 0; i < path->num_data; i += path->data[i].header.length)
    {
        if (path->data[i].header.length < 2) continue;
        auto& point = path->data[i + 1].point;
        const osg::Vec2d place = ruler.at(start + point.x, point.y - above() + lower);
        point.x = place.x();
        point.y = place.y();
    }
    cairo_new_path(target);
    cairo_append_path(target, path);
    cairo_path_destroy(path);
    _layout->paint(target);
    cairo_restore(target);
    return true;
}

osg::ref_ptr<osg::Image> LabelText::image(int margin) const
{
    if (_layout->ink.width <= 0) return nullptr;
    const int left = static_cast<int>(std::ceil(this->left())) + margin;
    const int above = static_cast<int>(std::ceil(this->above())) + margin;
    const int wide = left + static_cast<int>(std::ceil(width() - this->left())) + margin;
    const int high = above + static_cast<int>(std::ceil(height() - this->above())) + margin;
    cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, wide, high);
    cairo_t* const target = cairo_create(surface);
    draw(target, left, above);
    cairo_destroy(target);
    cairo_surface_flush(surface);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(wide, high, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; row < high; ++row)
    {
        const unsigned char* const from = cairo_image_surface_get_data(surface) + row * stride;
        unsigned char* const to = image->data(0, high - 1 - row);
        for (int x = 0; x < wide; ++x)
        {
            std::uint32_t pixel = 0;
            std::memcpy(&pixel, from + 4 * x, 4);
            to[4 * x] = static_cast<unsigned char>(pixel >> 16);
            to[4 * x + 1] = static_cast<unsigned char>(pixel >> 8);
            to[4 * x + 2] = static_cast<unsigned char>(pixel);
            to[4 * x + 3] = static_cast<unsigned char>(pixel >> 24);
        }
    }
    cairo_surface_destroy(surface);
    return image;
}

bool addFontFile(const std::string& file, std::string& family, std::string& error)
{
    FcFontSet* const set = FcFontSetCreate();
    FcStrSet* const folders = FcStrSetCreate();
    FcChar8* name = nullptr;
    const bool known =
        FcFileScan(set, folders, nullptr, nullptr, reinterpret_cast<const FcChar8*>(file.c_str()), FcTrue) &&
        set->nfont > 0 && FcPatternGetString(set->fonts[0], FC_FAMILY, 0, &name) == FcResultMatch;
    if (known) family = reinterpret_cast<const char*>(name);
    FcStrSetDestroy(folders);
    FcFontSetDestroy(set);
    if (!known || !FcConfigAppFontAddFile(nullptr, reinterpret_cast<const FcChar8*>(file.c_str())))
    {
        error = "\"" + file +
                "\" is not a font; name a file such as NotoSans.ttf, or the family of an installed font.";
        return false;
    }
    return true;
}

} // namespace osgGeoFX
