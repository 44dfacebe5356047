// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The areas, lines and points of vector data as they lie on the ground: each texel of a tile against GeographicLib's places and what the style file
// says, at several magnifications, on the globe and on a plane, from several formats and coordinate systems; and what is refused.
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/TiledVectors.h>
#include <tools/GeofxPlugins.h>
#include <tools/KmlFiles.h>
#include <tools/Outlines.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cpl_string.h>
#include <ogrsf_frmts.h>
#include <osg/Math>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <sys/resource.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Ring = std::vector<osg::Vec2d>; // degrees

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::string sld(const std::string& rules, const std::string& layer = "")
{
    return R"(<?xml version="1.0"?><StyledLayerDescriptor version="1.0.0" xmlns="http://www.opengis.net/sld"
 xmlns:ogc="http://www.opengis.net/ogc" xmlns:xlink="http://www.w3.org/1999/xlink"><NamedLayer><Name>)" +
           layer + "</Name><UserStyle><FeatureTypeStyle>" + rules +
           "</FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>";
}

std::string fill(const std::string& color, const std::string& opacity = "1")
{
    return "<Fill><CssParameter name=\"fill\">" + color +
           "</CssParameter><CssParameter name=\"fill-opacity\">" + opacity + "</CssParameter></Fill>";
}

std::string stroke(const std::string& color, const std::string& width, const std::string& more = "")
{
    return "<Stroke><CssParameter name=\"stroke\">" + color +
           "</CssParameter><CssParameter name=\"stroke-width\">" + width + "</CssParameter>" + more +
           "</Stroke>";
}

std::string rule(const std::string& symbolizer, const std::string& filter = "")
{
    return "<Rule>" + filter + symbolizer + "</Rule>";
}

std::string equals(const std::string& field, const std::string& value)
{
    return "<ogc:Filter><ogc:PropertyIsEqualTo><ogc:PropertyName>" + field +
           "</ogc:PropertyName><ogc:Literal>" + value + "</ogc:Literal></ogc:PropertyIsEqualTo></ogc:Filter>";
}

const std::string metres = " uom=\"http://www.opengeospatial.org/se/units/metre\"";

class TiledVectorsTest : public GeofxPlugins
{
protected:
    void SetUp() override { GDALAllRegister(); }

    static std::string ringText(const Ring& ring)
    {
        std::string text;
        for (std::size_t i = 0; i <= ring.size(); ++i)
            text += CPLSPrintf("%s%.12f %.12f", i > 0 ? "," : "", ring[i % ring.size()].x(),
                               ring[i % ring.size()].y());
        return "(" + text + ")";
    }
    static std::string polygon(const Ring& outer, const std::vector<Ring>& holes = {})
    {
        std::string text = "(" + ringText(outer);
        for (const Ring& hole : holes)
            text += "," + ringText(hole);
        return text + ")";
    }

    struct Feature
    {
        std::string wkt; ///< degrees
        std::string kind;
        double number = 0.0;
    };
    /// A file with the fields kind (text) and number (real), in any format and coordinate system.
    std::string write(const std::string& name, const std::vector<Feature>& features,
                      const char* format = "GeoJSON", int epsg = 4326)
    {
        const std::string file = (_folder / name).string();
        GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(format);
        GDALDataset* const dataset = driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
        EXPECT_TRUE(dataset);
        OGRSpatialReference degrees, own;
        degrees.importFromEPSG(4326);
        degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        if (epsg > 0) own.importFromEPSG(epsg);
        own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        OGRLayer* const layer = dataset->CreateLayer("things", epsg > 0 ? &own : nullptr);
        OGRFieldDefn kind("kind", OFTString), number("number", OFTReal);
        layer->CreateField(&kind);
        layer->CreateField(&number);
        const std::unique_ptr<OGRCoordinateTransformation> to(
            epsg > 0 ? OGRCreateCoordinateTransformation(&degrees, &own) : nullptr);
        for (const Feature& each : features)
        {
            OGRFeature feature(layer->GetLayerDefn());
            if (!each.wkt.empty())
            {
                OGRGeometry* geometry = nullptr;
                EXPECT_EQ(OGRGeometryFactory::createFromWkt(each.wkt.c_str(), nullptr, &geometry),
                          OGRERR_NONE)
                    << each.wkt;
                if (to) geometry->transform(to.get());
                feature.SetGeometryDirectly(geometry);
            }
            if (!each.kind.empty()) feature.SetField("kind", each.kind.c_str());
            feature.SetField("number", each.number);
            EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
        }
        GDALClose(dataset);
        return file;
    }

    bool read(const std::string& file, const std::string& style = "")
    {
        OverlayReader::Options options;
        options.style = style;
        std::string error;
        const bool done = _reader.read(file, options, error);
        EXPECT_TRUE(done) << error;
        return done;
    }
    std::string faultOf(const std::string& file, const std::string& style = "", const std::string& layer = "")
    {
        OverlayReader::Options options;
        options.style = style;
        options.layer = layer;
        std::string error;
        EXPECT_FALSE(_reader.read(file, options, error));
        EXPECT_TRUE(!error.empty() && error.back() == '.') << error;
        return error;
    }

    /// Degrees in the frame of an overlay, metres.
    osg::Vec2d placed(const osg::Vec2d& degrees, std::size_t frame = 0) const
    {
        double x = 0.0, y = 0.0, z = 0.0;
        const LocalOrigin& origin = _reader.frames[frame];
        if (_reader.globe)
        {
            const GeographicLib::LocalCartesian local(osg::RadiansToDegrees(origin.latitude),
                                                      osg::RadiansToDegrees(origin.longitude), 0.0);
            local.Forward(degrees.y(), degrees.x(), 0.0, x, y, z);
            return {x, y};
        }
        int zone = 0;
        bool north = false;
        GeographicLib::UTMUPS::Forward(degrees.y(), degrees.x(), zone, north, x, y, 4);
        return osg::Vec2d(x, y) - origin.place();
    }
    /// A ring whose edges are straight in degrees, in the frame.
    std::vector<osg::Vec2d> placed(const Ring& ring) const
    {
        constexpr int parts = 16;
        std::vector<osg::Vec2d> result;
        for (std::size_t i = 0; i < ring.size(); ++i)
            for (int part = 0; part < parts; ++part)
                result.push_back(
                    placed(ring[i] + (ring[(i + 1) % ring.size()] - ring[i]) * (1.0 * part / parts)));
        return result;
    }

    osg::ref_ptr<osg::Image> tile(const osg::Vec2d& middle, double texel, int side = 128,
                                  std::size_t overlay = 0)
    {
        const osg::Vec2d half(texel * side / 2.0, texel * side / 2.0);
        std::string error;
        osg::ref_ptr<osg::Image> image =
            _reader.overlays.at(overlay).tiles->read(middle - half, middle + half, side, side, error);
        EXPECT_TRUE(image) << error;
        return image;
    }
    static std::array<int, 4> at(const osg::Image& image, int x, int y)
    {
        const unsigned char* const texel =
            image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return {texel[0], texel[1], texel[2], texel[3]};
    }
    std::array<int, 4> at(const osg::Vec2d& degrees, double texel = 0.5)
    {
        return at(*tile(placed(degrees), texel, 16), 8, 8);
    }

    TempDir _folder;
    OverlayReader _reader;
};

/// How far a place lies inside of some rings by the even-odd rule; negative outside.
double insideOfAll(const std::vector<std::vector<osg::Vec2d>>& rings, const osg::Vec2d& place)
{
    bool within = false;
    double nearest = 1e30;
    for (const std::vector<osg::Vec2d>& ring : rings)
    {
        const double depth = insideOf(ring, place);
        within = within != (depth > 0.0);
        nearest = std::min(nearest, std::abs(depth));
    }
    return within ? nearest : -nearest;
}

} // namespace

// A polygon with holes, and one of several parts, at 500 to 0.05 m a texel, from formats and coordinate systems as people have them.
TEST_F(TiledVectorsTest, AreasHaveTheirPlacesHolesAndPartsAtAnyMagnification)
{
    const std::string style = _folder.write(
        "look.sld", sld(rule("<PolygonSymbolizer>" + fill("#ff8000", "0.5") + "</PolygonSymbolizer>")));
    Random random(7);
    const osg::Vec2d middle(-157.9, 21.4);
    const auto around = [&](const osg::Vec2d& center, double radius, int corners)
    {
        Ring ring;
        for (int i = 0; i < corners; ++i)
        {
            const double angle = 2.0 * osg::PI * i / corners, reach = radius * random.uniform(0.6, 1.0);
            ring.push_back(center + osg::Vec2d(reach * std::cos(angle), reach * std::sin(angle)));
        }
        return ring;
    };
    const std::vector<Ring> rings = {
        around(middle, 0.06, 11), around(middle + osg::Vec2d(0.01, 0.01), 0.012, 5),
        around(middle - osg::Vec2d(0.015, 0.01), 0.012, 7), around(middle + osg::Vec2d(0.1, 0.02), 0.03, 6)};
    const std::string wkt =
        "MULTIPOLYGON(" + polygon(rings[0], {rings[1], rings[2]}) + "," + polygon(rings[3]) + ")";
    struct Source
    {
        const char* name;
        const char* format;
        int epsg;
    };
    for (const bool globe : {true, false})
    {
        for (const Source& source : std::vector<Source>{{"a.geojson", "GeoJSON", 4326},
                                                        {"a.gpkg", "GPKG", 4326},
                                                        {"a.shp", "ESRI Shapefile", 32604},
                                                        {"b.gpkg", "GPKG", 3857}})
        {
            SCOPED_TRACE(source.name + std::string(globe ? " on a globe" : " on a plane"));
            _reader = OverlayReader();
            _reader.globe = globe;
            if (!globe) _reader.wkt = wktOf(32604);
            std::filesystem::remove(_folder / source.name);
            ASSERT_TRUE(read(write(source.name, {{wkt, "", 0.0}}, source.format, source.epsg), style));
            ASSERT_EQ(_reader.overlays.size(), 1u);
            ASSERT_TRUE(_reader.overlays[0].tiles);
            std::vector<std::vector<osg::Vec2d>> there;
            for (const Ring& ring : rings)
                there.push_back(placed(ring));
            // Straight lines of a projection are others than those in degrees: by 0.3 m at most here.
            const double bend = source.epsg == 4326 ? 0.01 : 0.5;
            for (const double texel : {500.0, 20.0, 1.0, 0.05})
            {
                // Around the whole, and at corners of the outline and of a hole.
                int inside = 0, outside = 0;
                for (const osg::Vec2d& at : {placed(middle), placed(rings[0][2]), placed(rings[1][1])})
                {
                    const osg::ref_ptr<osg::Image> image = tile(at, texel, 64);
                    for (int y = 0; y < 64; ++y)
                    {
                        for (int x = 0; x < 64; ++x)
                        {
                            const osg::Vec2d place = at + osg::Vec2d(x - 31.5, y - 31.5) * texel;
                            const double depth = insideOfAll(there, place);
                            if (std::abs(depth) < std::max(texel, bend)) continue;
                            const std::array<int, 4> color = TiledVectorsTest::at(*image, x, y);
                            ASSERT_NEAR(color[3], depth > 0.0 ? 128 : 0, 1)
                                << texel << ": " << x << " " << y << " depth " << depth;
                            (depth > 0.0 ? inside : outside)++;
                            if (depth < 0.0) continue;
                            ASSERT_NEAR(color[0], 255, 2);
                            ASSERT_NEAR(color[1], 128, 2);
                            ASSERT_NEAR(color[2], 0, 2);
                        }
                    }
                }
                if (texel > 1.0)
                {
                    EXPECT_GT(inside, 100);
                }
                EXPECT_GT(outside + inside, 1000);
            }
        }
    }
}

// The opacity of an edge's texels is the share that the area has of them, and their color the area's, so that no seam is dark.
TEST_F(TiledVectorsTest, EdgesAreSmoothAndTilesFitTogether)
{
    const Ring box = {{7.0, 45.0}, {7.013, 45.001}, {7.011, 45.012}, {6.998, 45.01}};
    const std::string style = _folder.write(
        "look.sld", sld(rule("<PolygonSymbolizer>" + fill("#20c040") + "</PolygonSymbolizer>")));
    ASSERT_TRUE(read(write("a.geojson", {{"POLYGON" + polygon(box), "", 0.0}}), style));
    const std::vector<osg::Vec2d> outline = placed(box);
    const osg::Vec2d corner = placed(box[1]);
    constexpr double texel = 4.0;
    const osg::ref_ptr<osg::Image> image = tile(corner, texel);
    int partial = 0;
    for (int y = 0; y < 128; ++y)
    {
        for (int x = 0; x < 128; ++x)
        {
            int count = 0;
            for (int i = 0; i < 64; ++i)
                count += insideOf(outline, corner + osg::Vec2d(x - 64 + (i % 8 + 0.5) / 8.0,
                                                               y - 64 + (i / 8 + 0.5) / 8.0) *
                                                        texel) > 0.0;
            const std::array<int, 4> color = at(*image, x, y);
            ASSERT_NEAR(color[3], 255.0 * count / 64.0, 255.0 * 0.07) << x << " " << y;
            if (count == 0 || count == 64) continue;
            ++partial;
            EXPECT_NEAR(color[0], 0x20, 6);
            EXPECT_NEAR(color[1], 0xc0, 6);
            // And so have their transparent neighbours.
            if (x < 127)
            {
                EXPECT_NEAR(at(*image, x + 1, y)[1], 0xc0, 6);
            }
        }
    }
    EXPECT_GT(partial, 50);
    // Two tiles are one picture.
    std::string error;
    RasterTiles& tiles = *_reader.overlays[0].tiles;
    const osg::Vec2d low = corner - osg::Vec2d(64.0, 64.0) * texel;
    const osg::ref_ptr<osg::Image> right =
        tiles.read(low + osg::Vec2d(60.0 * texel, 0.0), low + osg::Vec2d(124.0, 64.0) * texel, 64, 64, error);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            ASSERT_NEAR(at(*right, x, y)[3], at(*image, x + 60, y)[3], 12) << x << " " << y;
}

TEST_F(TiledVectorsTest, LinesHaveTheWidthOfTheirUnitAndTheirDashes)
{
    // 0.02 degrees of a meridian; and the same as a polygon's border.
    const std::string line = "LINESTRING(7 45,7 45.02)";
    const std::string style = _folder.write(
        "look.sld",
        sld(rule("<LineSymbolizer" + metres + ">" + stroke("#0000ff", "40") + "</LineSymbolizer>")));
    ASSERT_TRUE(read(write("a.geojson", {{line, "", 0.0}}), style));
    const osg::Vec2d middle = placed(osg::Vec2d(7.0, 45.01));
    const auto sumOf = [&](double texel, int y)
    {
        const osg::ref_ptr<osg::Image> image = tile(middle, texel);
        double sum = 0.0;
        for (int x = 0; x < 128; ++x)
            sum += at(*image, x, y)[3] / 255.0;
        return sum;
    };
    for (const double texel : {1.0, 3.7, 11.0})
        EXPECT_NEAR(sumOf(texel, 64) * texel, 40.0, 0.5) << texel;
    // Far away a line that is thinner than a texel is faint.
    EXPECT_NEAR(sumOf(200.0, 64), 0.2, 0.03);
    // In pixels, a line is as wide in any tile, within what a tile's texel may be.
    _reader = OverlayReader();
    ASSERT_TRUE(read((_folder / "a.geojson").string(),
                     _folder.write("look.sld", sld(rule("<LineSymbolizer>" + stroke("#0000ff", "3") +
                                                        "</LineSymbolizer>")))));
    for (const double texel : {0.3, 4.0})
        EXPECT_NEAR(sumOf(texel, 64), 3.0 * 1.41, 0.1) << texel;
    // Dashes of 100 m with gaps of 50 m begin at the line's start, in whatever tile.
    _reader = OverlayReader();
    ASSERT_TRUE(
        read((_folder / "a.geojson").string(),
             _folder.write("look.sld",
                           sld(rule("<LineSymbolizer" + metres + ">" +
                                    stroke("#0000ff", "40",
                                           "<CssParameter name=\"stroke-dasharray\">100 50</CssParameter>") +
                                    "</LineSymbolizer>")))));
    const double start = placed(osg::Vec2d(7.0, 45.0)).y();
    for (const double texel : {1.0, 4.0})
    {
        const osg::ref_ptr<osg::Image> image = tile(middle, texel);
        for (int y = 0; y < 128; ++y)
        {
            const double along = std::fmod(middle.y() + (y - 63.5) * texel - start, 150.0);
            const double edge = std::min({along, std::abs(along - 100.0), 150.0 - along});
            if (edge < texel) continue;
            EXPECT_EQ(at(*image, 64, y)[3], along < 100.0 ? 255 : 0) << texel << " " << along;
        }
    }
}

// Rules as QGIS and GeoServer write them: filters, else, values of fields, both versions of the standard, borders and order.
TEST_F(TiledVectorsTest, RulesAndFieldsChooseTheLook)
{
    std::vector<Feature> features;
    const auto box = [](int i)
    {
        const double west = 7.0 + 0.01 * i;
        return "POLYGON" +
               polygon({{west, 45.0}, {west + 0.008, 45.0}, {west + 0.008, 45.008}, {west, 45.008}});
    };
    const char* const kinds[] = {"wood", "Water", "", "town 1", "town 2", "other"};
    for (int i = 0; i < 6; ++i)
        features.push_back({box(i), kinds[i], 10.0 * i});
    const auto area = [](const std::string& color)
    {
        return "<PolygonSymbolizer>" + fill(color) + "</PolygonSymbolizer>";
    };
    const std::string property = "<ogc:PropertyName>kind</ogc:PropertyName>";
    const std::string number = "<ogc:PropertyName>number</ogc:PropertyName>";
    const std::string rules =
        rule(area("#ff0000"), equals("kind", "wood")) +
        rule(area("#00ff00"), "<ogc:Filter><ogc:PropertyIsEqualTo matchCase=\"false\">" + property +
                                  "<ogc:Literal>water</ogc:Literal></ogc:PropertyIsEqualTo></ogc:Filter>") +
        rule(area("#0000ff"),
             "<ogc:Filter><ogc:PropertyIsNull>" + property + "</ogc:PropertyIsNull></ogc:Filter>") +
        rule(area("#ffff00"),
             "<ogc:Filter><ogc:And><ogc:PropertyIsLike wildCard=\"%\" singleChar=\"_\" escape=\"\\\">" +
                 property + "<ogc:Literal>t_wn%</ogc:Literal></ogc:PropertyIsLike><ogc:PropertyIsBetween>" +
                 number +
                 "<ogc:LowerBoundary><ogc:Literal>25</ogc:Literal></"
                 "ogc:LowerBoundary><ogc:UpperBoundary><ogc:Literal>30"
                 "</ogc:Literal></ogc:UpperBoundary></ogc:PropertyIsBetween></ogc:And></ogc:Filter>") +
        rule(area("#00ffff"),
             "<ogc:Filter><ogc:Or><ogc:PropertyIsGreaterThan>" + number +
                 "<ogc:Literal>9e9</ogc:Literal></"
                 "ogc:PropertyIsGreaterThan><ogc:Not><ogc:PropertyIsLessThan>" +
                 number +
                 "<ogc:Literal>100</ogc:Literal></ogc:PropertyIsLessThan></ogc:Not></ogc:Or></ogc:Filter>") +
        "<Rule><ElseFilter/>" + area("#ff00ff") + "</Rule>";
    ASSERT_TRUE(read(write("a.gpkg", features, "GPKG"), _folder.write("look.sld", sld(rules))));
    const std::array<int, 4> colors[] = {{255, 0, 0, 255},   {0, 255, 0, 255},   {0, 0, 255, 255},
                                         {255, 255, 0, 255}, {255, 0, 255, 255}, {255, 0, 255, 255}};
    for (int i = 0; i < 6; ++i)
        EXPECT_EQ(at(osg::Vec2d(7.004 + 0.01 * i, 45.004)), colors[i]) << i;
    EXPECT_EQ(at(osg::Vec2d(7.009, 45.004))[3], 0) << "between them";

    // Version 1.1, beside the file and by its name; widths of fields; the border over the area, both passes in their order.
    const auto se = [](const std::string& name, const std::string& value)
    {
        return "<se:SvgParameter name=\"" + name + "\">" + value + "</se:SvgParameter>";
    };
    _folder.write(
        "a.sld",
        R"(<StyledLayerDescriptor version="1.1.0" xmlns="http://www.opengis.net/sld" xmlns:se="http://www.opengis.net/se"
 xmlns:ogc="http://www.opengis.net/ogc"><NamedLayer><se:Name>things</se:Name><UserStyle><se:FeatureTypeStyle><se:Rule><se:PolygonSymbolizer
 uom="http://www.opengeospatial.org/se/units/metre"><se:Fill>)" +
            se("fill", "#000") + "</se:Fill><se:Stroke>" + se("stroke", "#ffffff") +
            se("stroke-width", "<ogc:Add>" + number + "<ogc:Literal>20</ogc:Literal></ogc:Add>") +
            "</se:Stroke></se:PolygonSymbolizer><se:TextSymbolizer/></se:Rule></"
            "se:FeatureTypeStyle><se:FeatureTypeStyle>"
            "<se:Rule><se:LineSymbolizer uom=\"http://www.opengeospatial.org/se/units/metre\"><se:Stroke>" +
            se("stroke", "#ff0000") + se("stroke-width", "4") +
            "</se:Stroke></se:LineSymbolizer></se:Rule></se:FeatureTypeStyle></UserStyle></NamedLayer>"
            "</StyledLayerDescriptor>");
    _reader = OverlayReader();
    ASSERT_TRUE(read((_folder / "a.gpkg").string()));
    EXPECT_EQ(_reader.notices.size(), 1u);
    const double metre = 1.0 / 111132.0 * 1.0;
    for (const int i : {0, 3})
    {
        const double half = (20.0 + 10.0 * i) / 2.0, x = 7.004 + 0.01 * i;
        const std::array<int, 4> white = {255, 255, 255, 255}, black = {0, 0, 0, 255}, red = {255, 0, 0, 255};
        EXPECT_EQ(at(osg::Vec2d(x, 45.0)), red) << "the second pass lies on top";
        EXPECT_EQ(at(osg::Vec2d(x, 45.0 - (half - 2.0) * metre)), white);
        EXPECT_EQ(at(osg::Vec2d(x, 45.0 + (half - 2.0) * metre)), white) << "the border lies over the area";
        EXPECT_EQ(at(osg::Vec2d(x, 45.0 + (half + 2.0) * metre)), black);
        EXPECT_EQ(at(osg::Vec2d(x, 45.0 - (half + 2.0) * metre))[3], 0);
    }
}

TEST_F(TiledVectorsTest, PointsAreSymbolsOfPicturesAndMarks)
{
    writePicture((_folder / "pin.png").string(), 20, 10,
                 [](int x, int) {
                     return std::array<int, 4>{x < 10 ? 255 : 0, 0, 200, 255};
                 });
    const std::string rules =
        rule("<PointSymbolizer><Graphic><ExternalGraphic><OnlineResource xlink:type=\"simple\" "
             "xlink:href=\"pin.png\"/>"
             "<Format>image/png</Format></ExternalGraphic><Size>24</Size></Graphic></PointSymbolizer>",
             equals("kind", "pin")) +
        rule("<PointSymbolizer" + metres + "><Graphic><Mark><WellKnownName>circle</WellKnownName>" +
                 fill("#00ff00") + "</Mark><Size>80</Size></Graphic></PointSymbolizer>",
             equals("kind", "disc")) +
        rule("<PointSymbolizer><Graphic><Mark><WellKnownName>triangle</WellKnownName>" + fill("#ff0000") +
                 "</Mark><Size>30</Size><Rotation>90</Rotation></Graphic></PointSymbolizer>",
             equals("kind", "turned"));
    const std::string file = write("a.geojson", {{"POINT(7 45)", "pin", 0.0},
                                                 {"MULTIPOINT(7.01 45.01,7.02 45)", "disc", 0.0},
                                                 {"POINT Z(7.03 45 1234)", "turned", 0.0},
                                                 {"POINT(7.04 45)", "none", 0.0}});
    ASSERT_TRUE(read(file, _folder.write("look.sld", sld(rules))));
    ASSERT_EQ(_reader.overlays.size(), 4u);
    const osg::Vec2d places[] = {{7.0, 45.0}, {7.01, 45.01}, {7.02, 45.0}, {7.03, 45.0}};
    for (std::size_t i = 0; i < 4; ++i)
    {
        const GroundOverlay& overlay = _reader.overlays[i];
        const osg::Vec2d middle = (overlay.corners[0] + overlay.corners[2]) / 2.0;
        EXPECT_LT((middle - placed(places[i], overlay.frame)).length(), 1e-3) << i;
        ASSERT_TRUE(overlay.symbol);
        EXPECT_FALSE(overlay.tiles);
        const osg::ref_ptr<ProjectiveMapping> mapping = overlay.makeMapping();
        EXPECT_EQ(mapping->getTurned(), overlay.symbol->pixels > 0.0);
        EXPECT_EQ(mapping->getSizeInPixels(), overlay.symbol->pixels);
    }
    EXPECT_EQ(_reader.overlays[3].symbol->height.value_or(0.0), 1234.0);
    EXPECT_FALSE(_reader.overlays[0].symbol->height);
    EXPECT_EQ(_reader.overlays[1].layer, _reader.overlays[2].layer) << "shared";
    // How much of the square picture each has, and where.
    const auto shape = [&](std::size_t i, osg::Vec2d& low, osg::Vec2d& high)
    {
        const osg::Image& image = *_reader.overlays[i].layer->getImage();
        low.set(1e9, 1e9);
        high.set(-1e9, -1e9);
        double sum = 0.0;
        for (int y = 0; y < image.t(); ++y)
        {
            for (int x = 0; x < image.s(); ++x)
            {
                const double alpha = at(image, x, y)[3] / 255.0;
                sum += alpha;
                if (alpha < 0.5) continue;
                low.set(std::min(low.x(), 1.0 * x), std::min(low.y(), 1.0 * y));
                high.set(std::max(high.x(), x + 1.0), std::max(high.y(), y + 1.0));
            }
        }
        return sum;
    };
    osg::Vec2d low, high;
    const osg::Image& pin = *_reader.overlays[0].layer->getImage();
    shape(0, low, high);
    double unit = _reader.overlays[0].symbol->pixels / pin.s();
    EXPECT_NEAR((high.y() - low.y()) * unit, 24.0, 1.5);
    EXPECT_NEAR((high.x() - low.x()) * unit, 48.0, 1.5);
    EXPECT_GT(at(pin, pin.s() / 2 - 6, pin.t() / 2)[0], 250) << "left";
    EXPECT_LT(at(pin, pin.s() / 2 + 6, pin.t() / 2)[0], 5) << "right";
    const osg::Image& disc = *_reader.overlays[1].layer->getImage();
    const double side = _reader.overlays[1].corners[1].x() - _reader.overlays[1].corners[0].x();
    EXPECT_NEAR(shape(1, low, high) * std::pow(side / disc.s(), 2.0), osg::PI * 40.0 * 40.0, 60.0);
    // A triangle that points up points to the right when it is turned clockwise by 90 degrees.
    const osg::Image& turned = *_reader.overlays[3].layer->getImage();
    shape(3, low, high);
    const int top = static_cast<int>(high.x()) - 3, bottom = static_cast<int>(low.x()) + 3;
    int atTop = 0, atBottom = 0;
    for (int y = 0; y < turned.t(); ++y)
    {
        atTop += at(turned, top, y)[3] > 127;
        atBottom += at(turned, bottom, y)[3] > 127;
    }
    EXPECT_LT(4 * atTop, atBottom);
    // Pictures of elsewhere are not opened.
    _folder.write(
        "inner/look.sld",
        sld(rule("<PointSymbolizer><Graphic><ExternalGraphic><OnlineResource xlink:href=\"../pin.png\"/>"
                 "</ExternalGraphic></Graphic></PointSymbolizer>")));
    _reader = OverlayReader();
    EXPECT_TRUE(contains(faultOf(file, (_folder / "inner/look.sld").string()), "inner/look.sld:"))
        << "and --allow-outside";
}

// A KML file without ground overlays; OGR's drivers tell its styles.
TEST_F(TiledVectorsTest, StylesOfTheFileItselfAreTaken)
{
    const std::string file = _folder.write(
        "a.kml",
        kml("<Style "
            "id=\"s\"><PolyStyle><color>8000ff00</color></PolyStyle><LineStyle><color>ff0000ff</"
            "color><width>3</width></LineStyle>"
            "</Style><Placemark><styleUrl>#s</"
            "styleUrl><Polygon><outerBoundaryIs><LinearRing><coordinates>7,45 7.01,45 "
            "7.01,45.01 7,45.01 7,45</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"));
    ASSERT_TRUE(read(file));
    EXPECT_EQ(at(osg::Vec2d(7.005, 45.005)), (std::array<int, 4>{0, 255, 0, 128}));
    EXPECT_EQ(at(osg::Vec2d(7.005, 45.0)), (std::array<int, 4>{255, 0, 0, 255}));
    // Without any style there is some look.
    _reader = OverlayReader();
    ASSERT_TRUE(read(write("plain.geojson", {{"POLYGON((7 45,7.01 45,7.01 45.01,7 45))", "", 0.0}})));
    EXPECT_GT(at(osg::Vec2d(7.008, 45.002))[3], 50);
    EXPECT_EQ(at(osg::Vec2d(7.002, 45.008))[3], 0);
}

// Areas on all continents become six parts; over the antimeridian, around a pole, and cut there as GeoJSON wants it.
TEST_F(TiledVectorsTest, TheWholeWorldIsShownInSixParts)
{
    const std::string style = _folder.write(
        "look.sld",
        sld(rule("<PolygonSymbolizer>" + fill("#ff0000") + stroke("#0000ff", "1") + "</PolygonSymbolizer>")));
    ASSERT_TRUE(read(
        write("world.geojson",
              {{"POLYGON((-10 -10,40 -10,40 30,-10 30,-10 -10))", "", 0.0},
               {"MULTIPOLYGON(((170 -20,180 -20,180 10,170 10,170 -20)),((-180 -20,-165 -20,-165 10,-180 "
                "10,-180 -20)))",
                "", 0.0},
               {"POLYGON((-180 -90,180 -90,180 -70,-180 -70,-180 -90))", "", 0.0}}),
        style));
    EXPECT_EQ(_reader.overlays.size(), 3u) << "the other faces have nothing";
    const auto colorAt = [&](const osg::Vec2d& degrees)
    {
        std::array<int, 4> best{};
        for (std::size_t i = 0; i < _reader.overlays.size(); ++i)
        {
            const LocalOrigin& origin = _reader.frames[_reader.overlays[i].frame];
            const double x = osg::DegreesToRadians(degrees.x()), y = osg::DegreesToRadians(degrees.y());
            const double facing = std::sin(y) * std::sin(origin.latitude) +
                                  std::cos(y) * std::cos(origin.latitude) * std::cos(x - origin.longitude);
            if (facing < 0.5) continue;
            const std::array<int, 4> color =
                at(*tile(placed(degrees, _reader.overlays[i].frame), 2000.0, 16, i), 8, 8);
            if (color[3] > best[3]) best = color;
        }
        return best;
    };
    const std::array<int, 4> red = {255, 0, 0, 255};
    for (const osg::Vec2d& inside : std::vector<osg::Vec2d>{{0.0, 0.0},
                                                            {39.0, 29.0},
                                                            {-9.0, 29.0},
                                                            {175.0, 0.0},
                                                            {-170.0, 5.0},
                                                            {179.9, -10.0},
                                                            {0.0, -75.0},
                                                            {120.0, -71.0},
                                                            {-90.0, -88.0},
                                                            {45.0, -89.9}})
        EXPECT_EQ(colorAt(inside), red) << inside.x() << " " << inside.y();
    for (const osg::Vec2d& outside : std::vector<osg::Vec2d>{{-12.0, 0.0},
                                                             {42.0, 0.0},
                                                             {168.0, 0.0},
                                                             {-163.0, 0.0},
                                                             {0.0, -68.0},
                                                             {120.0, 50.0},
                                                             {0.0, 80.0},
                                                             {90.0, 0.0}})
        EXPECT_EQ(colorAt(outside)[3], 0) << outside.x() << " " << outside.y();
    // The meridian where the data were cut is no border.
    EXPECT_EQ(colorAt(osg::Vec2d(180.0, -80.0)), red);
    EXPECT_EQ(colorAt(osg::Vec2d(180.0, 0.0)), red);
    EXPECT_EQ(colorAt(osg::Vec2d(-165.0, 0.0))[2], 255) << "and here is one";
}

TEST_F(TiledVectorsTest, RingsThatCrossThemselvesAndEmptyFeaturesDoNoHarm)
{
    // A bow tie, and a square that is gone around twice in its middle.
    const std::string file = write("a.geojson", {{"POLYGON((7 45,7.02 45.02,7.02 45,7 45.02,7 45))", "", 0.0},
                                                 {"", "", 0.0},
                                                 {"POLYGON EMPTY", "", 0.0},
                                                 {"MULTIPOLYGON EMPTY", "", 0.0},
                                                 {"LINESTRING(7.05 45,7.05 45)", "", 0.0}});
    ASSERT_TRUE(read(file, _folder.write("look.sld", sld(rule("<PolygonSymbolizer>" + fill("#ff0000") +
                                                              "</PolygonSymbolizer>")))));
    EXPECT_EQ(at(osg::Vec2d(7.002, 45.01))[3], 255);
    EXPECT_EQ(at(osg::Vec2d(7.018, 45.01))[3], 255);
    EXPECT_EQ(at(osg::Vec2d(7.01, 45.002))[3], 0);
    EXPECT_EQ(at(osg::Vec2d(7.01, 45.018))[3], 0);
}

TEST_F(TiledVectorsTest, WhatCannotBeShownIsToldInASentence)
{
    const std::string area = "POLYGON((7 45,7.01 45,7.01 45.01,7 45))";
    const std::string file = write("a.geojson", {{area, "wood", 1.0}});
    const auto faultOfRules = [&](const std::string& rules)
    {
        return faultOf(file, _folder.write("look.sld", sld(rules)));
    };
    EXPECT_TRUE(contains(faultOf(write("nocrs.shp", {{area, "", 0.0}}, "ESRI Shapefile", 0)),
                         "nocrs.shp: its layer"));
    const std::string missing = faultOfRules(
        rule("<PolygonSymbolizer>" + fill("#ff0000") + "</PolygonSymbolizer>", equals("class", "1")));
    EXPECT_TRUE(contains(missing, "look.sld:") && contains(missing, "\"class\"") &&
                contains(missing, "a.geojson") && contains(missing, "kind, number"))
        << missing;
    EXPECT_TRUE(contains(faultOfRules(rule("<PolygonSymbolizer>" + fill("red") + "</PolygonSymbolizer>")),
                         "write #rrggbb"));
    EXPECT_TRUE(
        contains(faultOfRules(rule("<PolygonSymbolizer>" + fill("#ff0000", "2") + "</PolygonSymbolizer>")),
                 "from 0 to 1"));
    EXPECT_TRUE(contains(faultOfRules(rule("<PolygonSymbolizer>" + fill("#ff0000") + "</PolygonSymbolizer>",
                                           "<ogc:Filter><ogc:Intersects/></ogc:Filter>")),
                         "<Intersects>"));
    EXPECT_TRUE(contains(faultOfRules(rule("<PolygonSymbolizer>" + fill("#ff0000") + "</PolygonSymbolizer>",
                                           equals("kind", "x"))),
                         "no rule of its style"));
    EXPECT_TRUE(contains(faultOfRules(rule("<TextSymbolizer/>")), "no PolygonSymbolizer"));
    EXPECT_TRUE(
        contains(faultOf(file, _folder.write("broken.sld", "<a><b></a>")), "broken.sld:1: it is not XML"));
    EXPECT_TRUE(
        contains(faultOf(file, (_folder / "none.sld").string()), "none.sld: the style cannot be read"));
    EXPECT_TRUE(contains(faultOf(file, "", "roads"), "no layer \"roads\""));
    EXPECT_TRUE(contains(faultOf(write("empty.geojson", {{"", "", 0.0}})), "empty.geojson: "));
    EXPECT_TRUE(contains(faultOf(_folder.write("text.txt", "hello")), "text.txt: "));
    // On a plane that is elsewhere.
    _reader = OverlayReader();
    _reader.globe = false;
    _reader.wkt = wktOf(32604);
    EXPECT_TRUE(contains(faultOf(file), "none of its areas and lines lies where the terrain's projection"))
        << "7 degrees east";
    EXPECT_TRUE(_reader.overlays.empty() && _reader.frames.empty());
}

// A town of 100,000 houses: a tile takes time by what it shows, and memory stays small.
TEST_F(TiledVectorsTest, AHundredThousandFeaturesAreQuick)
{
    std::ofstream out(_folder / "town.geojson");
    out << R"({"type":"FeatureCollection","features":[)";
    constexpr int side = 316;
    for (int i = 0; i < side * side; ++i)
    {
        const double x = 7.0 + 0.0003 * (i % side), y = 45.0 + 0.0003 * (i / side);
        out << (i > 0 ? "," : "")
            << CPLSPrintf(
                   R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[%.6f,%.6f],[%.6f,%.6f],[%.6f,%.6f],[%.6f,%.6f],[%.6f,%.6f]]]}})",
                   x, y, x + 0.00015, y, x + 0.00015, y + 0.00015, x, y + 0.00015, x, y);
    }
    out << "]}";
    out.close();
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    ASSERT_TRUE(read((_folder / "town.geojson").string(),
                     _folder.write("look.sld", sld(rule("<PolygonSymbolizer>" + fill("#ff0000") +
                                                        "</PolygonSymbolizer>")))));
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 600 * 1024) << "KiB";
    // A quarter of the ground is houses, at any distance.
    for (const double texel : {0.1, 1.0, 300.0})
    {
        const osg::ref_ptr<osg::Image> image =
            tile(placed(osg::Vec2d(7.048, 45.047)), texel, texel > 100.0 ? 16 : 256);
        double sum = 0.0;
        for (int y = 0; y < image->t(); ++y)
            for (int x = 0; x < image->s(); ++x)
                sum += at(*image, x, y)[3] / 255.0;
        const double share = sum / (image->s() * image->t());
        if (texel > 0.5)
        {
            EXPECT_NEAR(share, 0.25, texel > 100.0 ? 0.05 : 0.12) << texel;
        }
    }
}
