// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Names as Pango lays them out, against Pango's own pictures of the same text.
#include <osgGeoFX/labels/LabelText.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

using namespace osgGeoFX;

namespace
{

LabelStyle plainStyle()
{
    LabelStyle style;
    style.font = "DejaVu Sans, Lohit Devanagari, IPAGothic";
    style.size = 40.0;
    style.haloWidth = 0.0;
    style.color.set(0.0f, 0.0f, 0.0f, 1.0f);
    return style;
}

/// What Pango itself draws: how far each pixel is covered, 0 to 255, first row uppermost. Cairo moves each glyph to a whole pixel,
/// so it is drawn eight times as large.
std::vector<int> drawnByPango(const std::string& text, const LabelStyle& style, int width, int height,
                              double x, double y)
{
    constexpr int times = 8;
    cairo_surface_t* const surface =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, times * width, times * height);
    cairo_t* const target = cairo_create(surface);
    cairo_scale(target, times, times);
    PangoLayout* const layout = pango_cairo_create_layout(target);
    PangoFontDescription* const font = pango_font_description_from_string(style.font.c_str());
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    cairo_font_options_t* const options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(pango_layout_get_context(layout), options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(pango_layout_get_context(layout), FALSE);
    pango_layout_context_changed(layout);
    pango_layout_set_text(layout, text.c_str(), -1);
    cairo_move_to(target, x, y - pango_layout_get_baseline(layout) / static_cast<double>(PANGO_SCALE));
    pango_cairo_show_layout(target, layout);
    g_object_unref(layout);
    cairo_destroy(target);
    cairo_surface_flush(surface);
    std::vector<int> alpha;
    for (int i = 0; i < width * height; ++i)
    {
        int sum = 0;
        for (int k = 0; k < times * times; ++k)
        {
            const int row = i / width * times + k / times, column = i % width * times + k % times;
            sum += cairo_image_surface_get_data(
                surface)[row * cairo_image_surface_get_stride(surface) + 4 * column + 3];
        }
        alpha.push_back(sum / (times * times));
    }
    cairo_surface_destroy(surface);
    return alpha;
}

} // namespace

// Five scripts, letters that join, that stand on each other, and that run to the left.
TEST(LabelText, LooksAsPangoSetsIt)
{
    for (const std::string text : {"Mount Kaʻala", "Эльбрус", "جبل طارق", "सगरमाथा", "富士山"})
    {
        SCOPED_TRACE(text);
        const LabelText label(text, plainStyle());
        const osg::ref_ptr<osg::Image> image = label.image();
        ASSERT_TRUE(image);
        const std::vector<int> expected =
            drawnByPango(text, plainStyle(), image->s(), image->t(), std::ceil(label.left()) + 1,
                         std::ceil(label.above()) + 1);
        int ink = 0, far = 0;
        for (int row = 0; row < image->t(); ++row)
        {
            for (int x = 0; x < image->s(); ++x)
            {
                const int actual = image->data(static_cast<unsigned int>(x),
                                               static_cast<unsigned int>(image->t() - 1 - row))[3];
                const int wanted = expected[static_cast<std::size_t>(row * image->s() + x)];
                ink += wanted > 128 ? 1 : 0;
                far += std::abs(actual - wanted) > 64 ? 1 : 0;
            }
        }
        EXPECT_GT(ink, 500);
        EXPECT_LE(far, ink / 100);
        EXPECT_EQ(label.missingLetters(), 0)
            << "no font has them: install fonts-lohit-deva and fonts-ipafont-gothic";
    }
}

TEST(LabelText, TheHaloLiesAroundTheLetters)
{
    LabelStyle style = plainStyle();
    const LabelText bare("Diamond Head", style);
    style.haloWidth = 0.1;
    style.halo.set(1.0f, 1.0f, 1.0f, 1.0f);
    const LabelText around("Diamond Head", style);
    EXPECT_NEAR(around.width(), bare.width() + 8.0, 1e-6);
    EXPECT_NEAR(around.height(), bare.height() + 8.0, 1e-6);
    const osg::ref_ptr<osg::Image> a = bare.image(), b = around.image();
    const auto inkOf = [](const osg::Image& image, bool dark)
    {
        int count = 0;
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
            {
                const unsigned char* pixel =
                    image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                count += pixel[3] > 128 && (pixel[0] < 128) == dark ? 1 : 0;
            }
        return count;
    };
    EXPECT_NEAR(inkOf(*a, true), inkOf(*b, true), 0.1 * inkOf(*a, true));
    EXPECT_EQ(inkOf(*a, false), 0);
    EXPECT_GT(inkOf(*b, false), inkOf(*b, true) / 2);
}

TEST(LabelText, LongNamesAreCutAndBrokenOnesAreMended)
{
    const LabelText whole("Oʻahu", plainStyle());
    EXPECT_FALSE(whole.isCut());
    const LabelText endless(std::string(10000, 'm'), plainStyle());
    EXPECT_TRUE(endless.isCut());
    EXPECT_LE(endless.width(), 30.0 * 40.0);
    EXPECT_GT(endless.width(), 20.0 * 40.0);
    const LabelText broken("Ka\xff\xfe"
                           "ala\n\x01peak",
                           plainStyle());
    EXPECT_GT(broken.width(), whole.width());
    EXPECT_LT(broken.height(), 2.0 * 40.0) << "one line";
    for (const std::string nothing : {"", " ", "\n\t"})
    {
        const LabelText empty(nothing, plainStyle());
        EXPECT_EQ(empty.width(), 0.0);
        EXPECT_EQ(empty.height(), 0.0);
        EXPECT_FALSE(empty.image());
    }
}

// Along a level line the letters are those of the straight text; along an arc each is as far from it as from a line.
TEST(LabelText, FollowsACurve)
{
    const LabelText label("Koʻolau Range", plainStyle());
    constexpr int side = 700;
    const auto draw = [&](const std::vector<osg::Vec2d>& curve, bool& drawn)
    {
        cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, side, side);
        cairo_t* const target = cairo_create(surface);
        if (curve.empty())
            label.draw(target, 350.0 - 0.5 * label.width() + label.left(), 350.0 + 10.0);
        else
            drawn = label.drawAlong(target, curve);
        cairo_destroy(target);
        cairo_surface_flush(surface);
        std::vector<int> alpha;
        for (int i = 0; i < side * side; ++i)
            alpha.push_back(cairo_image_surface_get_data(surface)[4 * i + 3]);
        cairo_surface_destroy(surface);
        return alpha;
    };
    bool drawn = false;
    const std::vector<int> straight = draw({}, drawn), level = draw({{50.0, 350.0}, {650.0, 350.0}}, drawn);
    ASSERT_TRUE(drawn);
    int differing = 0, ink = 0;
    for (std::size_t i = 0; i < straight.size(); ++i)
    {
        differing += std::abs(straight[i] - level[i]) > 40 ? 1 : 0;
        ink += straight[i] > 128 ? 1 : 0;
    }
    EXPECT_LE(differing, ink / 50);

    std::vector<osg::Vec2d> arc;
    for (int i = 0; i <= 60; ++i)
    {
        const double angle = 0.8 * 3.14159265 * (i / 60.0 - 0.5);
        arc.emplace_back(350.0 + 250.0 * std::sin(angle), 400.0 - 250.0 * std::cos(angle));
    }
    const std::vector<int> bent = draw(arc, drawn);
    ASSERT_TRUE(drawn);
    int bentInk = 0;
    double nearest = 1e9, farthest = 0.0;
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            if (bent[static_cast<std::size_t>(y * side + x)] <= 128) continue;
            ++bentInk;
            const double radius = std::hypot(x + 0.5 - 350.0, y + 0.5 - 400.0);
            nearest = std::min(nearest, radius);
            farthest = std::max(farthest, radius);
        }
    }
    EXPECT_NEAR(bentInk, ink, 0.1 * ink);

    // The same in a strip of a larger picture, whose upper border lies below the straight text.
    cairo_surface_t* const strip = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, side, 400);
    cairo_t* const target = cairo_create(strip);
    cairo_translate(target, 0.0, -100.0);
    EXPECT_TRUE(label.drawAlong(target, arc));
    cairo_destroy(target);
    cairo_surface_flush(strip);
    int otherwise = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(side) * 400; ++i)
        otherwise += std::abs(cairo_image_surface_get_data(strip)[4 * i + 3] -
                              bent[i + static_cast<std::size_t>(side) * 100]) > 2
                         ? 1
                         : 0;
    cairo_surface_destroy(strip);
    EXPECT_EQ(otherwise, 0);
    // Above the arc by the letters' height, below it by what hangs down.
    EXPECT_GT(nearest, 250.0 - 0.55 * 40.0);
    EXPECT_LT(farthest, 250.0 + 0.75 * 40.0);

    draw({{0.0, 0.0}, {20.0, 0.0}}, drawn);
    EXPECT_FALSE(drawn) << "too short";
}

TEST(LabelText, AFileThatIsNoFontIsASentence)
{
    const geofx::test::TempDir folder;
    const std::string file = (folder.path() / "font.ttf").string();
    std::ofstream(file) << "no font";
    std::string family, error;
    EXPECT_FALSE(addFontFile(file, family, error));
    EXPECT_TRUE(family.empty());
    EXPECT_NE(error.find("font.ttf"), std::string::npos);
    EXPECT_TRUE(addFontFile("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", family, error)) << error;
    EXPECT_EQ(family, "DejaVu Sans");
}
