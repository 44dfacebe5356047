// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Marks and hatches as QGIS and GeoServer write them into SLD files: how much each covers, where its lines run, and what stands in for what is not drawn.
#include <osgGeoFX/geodata/OverlayReader.h>
#include <tools/TempDir.h>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <osg/Math>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

std::string parameter(const std::string& name, const std::string& value)
{
    return "<se:SvgParameter name=\"" + name + "\">" + value + "</se:SvgParameter>";
}

std::string fill(const std::string& color)
{
    return "<se:Fill>" + parameter("fill", color) + "</se:Fill>";
}

std::string stroke(const std::string& color, const std::string& width)
{
    return "<se:Stroke>" + parameter("stroke", color) + parameter("stroke-width", width) + "</se:Stroke>";
}

std::string mark(const std::string& name, const std::string& look)
{
    return "<se:Mark><se:WellKnownName>" + name + "</se:WellKnownName>" + look + "</se:Mark>";
}

class SldMarks : public ::testing::Test
{
protected:
    void SetUp() override { GDALAllRegister(); }

    /// A square of about 2 km around 7° E, 45° N, or a point there, in such a style.
    void show(const std::string& geometry, const std::string& symbolizer)
    {
        const std::string file = _folder.write(
            "data.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},
"geometry":)" + geometry + "}]}");
        _folder.write(
            "data.sld",
            R"(<StyledLayerDescriptor version="1.1.0" xmlns="http://www.opengis.net/sld" xmlns:se="http://www.opengis.net/se"
 xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:ogc="http://www.opengis.net/ogc"><NamedLayer><se:Name/><UserStyle>
<se:FeatureTypeStyle><se:Rule>)" +
                symbolizer +
                "</se:Rule></se:FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>");
        _reader = OverlayReader();
        std::string error;
        ASSERT_TRUE(_reader.read(file, {}, error)) << error;
        ASSERT_EQ(_reader.overlays.size(), 1u);
    }
    void showArea(const std::string& area)
    {
        show(
            R"({"type":"Polygon","coordinates":[[[6.99,44.99],[7.01,44.99],[7.01,45.01],[6.99,45.01],[6.99,44.99]]]})",
            "<se:PolygonSymbolizer uom=\"http://www.opengeospatial.org/se/units/metre\">" + area +
                "</se:PolygonSymbolizer>");
    }
    void showPoint(const std::string& graphic)
    {
        show(R"({"type":"Point","coordinates":[7,45]})",
             "<se:PointSymbolizer><se:Graphic>" + graphic +
                 "<se:Size>40</se:Size></se:Graphic></se:PointSymbolizer>");
    }
    /// A mark as large as its tile, 20 metres.
    void showHatch(const std::string& name, const std::string& look, const std::string& more = "",
                   const std::string& margin = "")
    {
        showArea("<se:Fill><se:GraphicFill><se:Graphic>" + mark(name, look) + "<se:Size>20</se:Size>" + more +
                 "</se:Graphic></se:GraphicFill></se:Fill>" + margin);
    }

    /// Texels of a metre from the middle of the area on.
    osg::ref_ptr<osg::Image> tile(double x = 0.0, double y = 0.0, double texel = 1.0, int side = 200)
    {
        RasterTiles& tiles = *_reader.overlays[0].tiles;
        const osg::Vec2d low = (tiles.low() + tiles.high()) / 2.0 + osg::Vec2d(x, y);
        std::string error;
        osg::ref_ptr<osg::Image> image =
            tiles.read(low, low + osg::Vec2d(side * texel, side * texel), side, side, error);
        EXPECT_TRUE(image) << error;
        return image;
    }
    static std::array<int, 4> at(const osg::Image& image, int x, int y)
    {
        const unsigned char* const texel =
            image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return {texel[0], texel[1], texel[2], texel[3]};
    }
    /// The share that is covered, 0…1; what is covered must be red.
    static double covered(const osg::Image& image)
    {
        double sum = 0.0;
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
            {
                const std::array<int, 4> color = at(image, x, y);
                sum += color[3] / 255.0;
                if (color[3] < 100) continue;
                EXPECT_GT(color[0], 240);
                EXPECT_LT(color[1], 15);
            }
        return sum / image.s() / image.t();
    }
    /// Whether the texels are those of the place that is so many texels beside and above.
    static bool repeats(const osg::Image& image, int dx, int dy)
    {
        for (int y = std::max(0, -dy); y < image.t() - std::max(0, dy); ++y)
            for (int x = std::max(0, -dx); x < image.s() - std::max(0, dx); ++x)
                if (std::abs(at(image, x, y)[3] - at(image, x + dx, y + dy)[3]) > 6) return false;
        return true;
    }
    /// What a point's mark covers of its square.
    double coveredByMark()
    {
        const GroundOverlay& overlay = _reader.overlays[0];
        const double side = overlay.symbol->pixels / 40.0;
        return covered(*overlay.layer->getImage()) * side * side;
    }

    TempDir _folder;
    OverlayReader _reader;
};

} // namespace

TEST_F(SldMarks, HatchesAreLinesOverTheGround)
{
    struct Hatch
    {
        std::string name, more;
        double covered;
        std::vector<std::array<int, 2>> repeats, differs;
    };
    const double diagonal = 4.0 / (20.0 * std::sqrt(0.5));
    const auto both = [](double share)
    {
        return 1.0 - (1.0 - share) * (1.0 - share);
    };
    const std::string turned = "<se:Rotation>45</se:Rotation>";
    for (const Hatch& hatch :
         std::vector<Hatch>{{"horline", "", 0.2, {{1, 0}, {0, 20}}, {{0, 10}}},
                            {"shape://horline", "", 0.2, {{1, 0}, {0, 20}}, {{0, 10}}},
                            {"line", "", 0.2, {{0, 1}, {20, 0}}, {{10, 0}}},
                            {"shape://vertline", "", 0.2, {{0, 1}, {20, 0}}, {{10, 0}}},
                            {"slash", "", diagonal, {{1, 1}, {20, 0}, {0, 20}}, {{1, -1}, {10, 0}}},
                            {"shape://backslash", "", diagonal, {{1, -1}, {20, 0}}, {{1, 1}, {10, 0}}},
                            {"shape://plus", "", both(0.2), {{20, 0}, {0, 20}}, {{10, 0}, {1, 1}}},
                            {"shape://times", "", both(diagonal), {{20, 0}, {0, 20}}, {{1, 1}, {1, -1}}},
                            // As QGIS writes lines of any direction.
                            {"horline", turned, 0.2, {{1, -1}}, {{1, 1}, {20, 0}}}})
    {
        SCOPED_TRACE(hatch.name + hatch.more);
        showHatch(hatch.name, stroke("#ff0000", "4"), hatch.more);
        EXPECT_TRUE(_reader.notices.empty());
        const osg::ref_ptr<osg::Image> image = tile();
        EXPECT_NEAR(covered(*image), hatch.covered, 0.02);
        for (const auto& [dx, dy] : hatch.repeats)
            EXPECT_TRUE(repeats(*image, dx, dy)) << dx << " " << dy;
        for (const auto& [dx, dy] : hatch.differs)
            EXPECT_FALSE(repeats(*image, dx, dy)) << dx << " " << dy;
        // Tiles fit together.
        const osg::ref_ptr<osg::Image> beside = tile(37.0, 53.0);
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 100; ++x)
                ASSERT_NEAR(at(*beside, x, y)[3], at(*image, x + 37, y + 53)[3], 6) << x << " " << y;
        // Not beyond the area, and from afar an even tint of it.
        EXPECT_EQ(covered(*tile(1500.0)), 0.0);
        EXPECT_NEAR(covered(*tile(-400.0, -400.0, 16.0, 40)), hatch.covered, 0.05);
    }
}

TEST_F(SldMarks, HatchesMayBeDashed)
{
    showHatch("horline", "<se:Stroke>" + parameter("stroke", "#ff0000") + parameter("stroke-width", "4") +
                             parameter("stroke-dasharray", "6 10") + "</se:Stroke>");
    const osg::ref_ptr<osg::Image> image = tile(0.0, 0.0, 1.0, 160);
    EXPECT_NEAR(covered(*image), 0.2 * 6.0 / 16.0, 0.01);
    EXPECT_TRUE(repeats(*image, 16, 0));
    EXPECT_FALSE(repeats(*image, 8, 0));
    const osg::ref_ptr<osg::Image> beside = tile(37.0, 53.0, 1.0, 100);
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
            ASSERT_NEAR(at(*beside, x, y)[3], at(*image, x + 37, y + 53)[3], 6) << x << " " << y;
}

TEST_F(SldMarks, LinesWithAFillAloneHaveItsColor)
{
    // As QGIS writes its brushes.
    showHatch("slash", fill("#ff0000"));
    EXPECT_NEAR(covered(*tile()), 1.0 / (20.0 * std::sqrt(0.5)), 0.01);
}

TEST_F(SldMarks, OtherMarksFillAreasSideBySide)
{
    showHatch("circle", fill("#ff0000"), "<se:Opacity>1</se:Opacity>");
    const osg::ref_ptr<osg::Image> circles = tile();
    EXPECT_NEAR(covered(*circles), osg::PI_4, 0.01);
    EXPECT_TRUE(repeats(*circles, 20, 0));
    EXPECT_TRUE(repeats(*circles, 0, 20));
    EXPECT_FALSE(repeats(*circles, 10, 0));
    showHatch("circle", fill("#ff0000"), "",
              "<se:VendorOption name=\"graphic-margin\">5 10 5 10</se:VendorOption>");
    const osg::ref_ptr<osg::Image> apart = tile(0.0, 0.0, 1.0, 120);
    EXPECT_NEAR(covered(*apart), osg::PI * 100.0 / (40.0 * 30.0), 0.01);
    EXPECT_TRUE(repeats(*apart, 40, 0));
    EXPECT_TRUE(repeats(*apart, 0, 30));
    showHatch("brush://dense4", fill("#ff0000"));
    EXPECT_TRUE(_reader.notices.empty());
    EXPECT_EQ(at(*tile(), 50, 50), (std::array<int, 4>{255, 0, 0, 128}));
}

TEST_F(SldMarks, APictureThatFillsAnAreaIsLeftOutAndNotGrey)
{
    showArea("<se:Fill><se:GraphicFill><se:Graphic><se:ExternalGraphic><se:OnlineResource "
             "xlink:href=\"wood.png\"/>"
             "<se:Format>image/png</se:Format></se:ExternalGraphic></se:Graphic></se:GraphicFill></se:Fill>" +
             stroke("#ff0000", "4"));
    EXPECT_EQ(covered(*tile()), 0.0);
    ASSERT_EQ(_reader.notices.size(), 1u);
    EXPECT_NE(_reader.notices[0].find("a picture that fills areas is left out"), std::string::npos);
    showArea("<se:Fill><se:GraphicFill><se:Graphic><se:ExternalGraphic><se:OnlineResource "
             "xlink:href=\"http://example.org/wood.png\"/></se:ExternalGraphic>" +
             mark("horline", stroke("#ff0000", "4")) +
             "<se:Size>20</se:Size></se:Graphic></se:GraphicFill></se:Fill>");
    EXPECT_NEAR(covered(*tile()), 0.2, 0.02);
}

TEST_F(SldMarks, CoverWhatTheirShapeDoes)
{
    const double circle = osg::PI_4;
    const std::map<std::string, double> shares = {{"square", 1.0},
                                                  {"circle", circle},
                                                  {"triangle", 0.5},
                                                  {"equilateral_triangle", 0.3248},
                                                  {"diamond", 0.5},
                                                  {"pentagon", 0.5944},
                                                  {"hexagon", 0.6495},
                                                  {"octagon", 0.8284},
                                                  {"decagon", 0.7347},
                                                  {"star", 0.2806},
                                                  {"cross", 0.4375},
                                                  {"cross_fill", 0.4375},
                                                  {"x", 0.4375},
                                                  {"shield", 0.875},
                                                  {"half_square", 0.5},
                                                  {"quarter_square", 0.25},
                                                  {"diagonal_half_square", 0.5},
                                                  {"left_half_triangle", 0.25},
                                                  {"trapezoid", 0.375},
                                                  {"parallelogram_right", 0.375},
                                                  {"semi_circle", circle / 2.0},
                                                  {"third_circle", circle / 3.0},
                                                  {"quarter_circle", circle / 4.0},
                                                  {"arrow", 0.25},
                                                  {"filled_arrowhead", 0.25},
                                                  {"square_with_corners", 0.92},
                                                  {"rounded_square", 1.0 - (4.0 - osg::PI) * 0.015625},
                                                  {"shape://dot", osg::PI * 0.015625},
                                                  {"extshape://triangle", 0.5}};
    for (const auto& [name, share] : shares)
    {
        SCOPED_TRACE(name);
        showPoint(mark(name, fill("#ff0000")));
        EXPECT_TRUE(_reader.notices.empty());
        EXPECT_NEAR(coveredByMark(), share, 0.02);
    }
    for (const char* const name :
         {"heart", "star_diamond", "asterisk_fill", "parallelogram_left", "right_half_triangle"})
    {
        SCOPED_TRACE(name);
        showPoint(mark(name, fill("#ff0000")));
        EXPECT_TRUE(_reader.notices.empty());
        EXPECT_GT(coveredByMark(), 0.2);
        EXPECT_LT(coveredByMark(), 0.8);
    }
    // Lines, a tenth of their length wide.
    for (const char* const name : {"line", "horline", "shape://vertline"})
    {
        SCOPED_TRACE(name);
        showPoint(mark(name, stroke("#ff0000", "4")));
        EXPECT_NEAR(coveredByMark(), 0.1, 0.01);
    }
    showPoint(mark("ttf://Webdings#0x0064", fill("#ff0000")));
    ASSERT_EQ(_reader.notices.size(), 1u);
    EXPECT_NE(_reader.notices[0].find("the mark \"ttf://Webdings#0x0064\" is drawn as a square"),
              std::string::npos);
    EXPECT_NEAR(coveredByMark(), 1.0, 0.03);
}

TEST_F(SldMarks, StandInForPicturesThatAreNotDrawn)
{
    // As QGIS writes markers of SVG, with parameters and without, and pictures within the style.
    const auto external = [](const std::string& name)
    {
        return "<se:ExternalGraphic><se:OnlineResource xlink:type=\"simple\" xlink:href=\"" + name +
               "\"/><se:Format>image/svg+xml</se:Format></se:ExternalGraphic>";
    };
    for (const std::string& pictures :
         {external("gpsicons/plane.svg?fill=%23e15989&amp;fill-opacity=1&amp;stroke=%23232323") +
              external("gpsicons/plane.svg"),
          external("base64:PHN2ZyB4bWxucz0iaHR0cDovL3d3dy53My5vcmcvMjAwMC9zdmciLz4="),
          external("data:image/png;base64,iVBORw0KGgo=")})
    {
        SCOPED_TRACE(pictures);
        showPoint(pictures + mark("diamond", fill("#ff0000")));
        EXPECT_NEAR(coveredByMark(), 0.5, 0.02);
        ASSERT_FALSE(_reader.notices.empty());
        EXPECT_NE(_reader.notices[0].find("the next mark is"), std::string::npos) << _reader.notices[0];
    }
}
