// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/KmlReader.h>

#include <osgGeoFX/geodata/detail/KmlStream.h>

#include <osg/Math>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t mostOverlays = 10000;

/// What a GroundOverlay says, as text.
struct Draft
{
    int line = 0;
    std::string name, href, color, order;
    std::string north, south, east, west, rotation, quad, altitudeMode;
    bool hasBox = false, hasQuad = false;
};

class Parser : public KmlStream
{
public:
    Parser(const std::string& document, const KmlReader::Inherited& inherited)
        : KmlStream(document), _inherited{inherited}
    {
    }

    KmlReader::Content read()
    {
        parse();
        _content.bytes = bytes();
        return std::move(_content);
    }

private:
    void begin() override
    {
        if (isKmlFeature(element())) _inherited.push_back(_inherited.back());
        if (element() == "GroundOverlay")
        {
            _overlay = Draft();
            _overlay->line = line();
        }
        if (element() == "NetworkLink") _link = KmlReader::Link{{}, line(), {}};
        if (!_overlay) return;
        if (isAt({"GroundOverlay", "LatLonBox"})) _overlay->hasBox = true;
        if (isAt({"GroundOverlay", "LatLonQuad"})) _overlay->hasQuad = true;
    }

    void end() override
    {
        takeFeature();
        if (_overlay) takeOverlay();
        if (_link && (isAt({"NetworkLink", "Link", "href"}) || isAt({"NetworkLink", "Url", "href"})))
            _link->href = text();
        if (element() == "GroundOverlay" && _overlay)
        {
            finishOverlay();
            _overlay.reset();
        }
        if (element() == "NetworkLink" && _link)
        {
            _link->inherited = _inherited.back();
            if (_content.links.size() >= mostKmlLinks) fail(_link->line, tooManyLinks);
            if (!_link->href.empty()) _content.links.push_back(*_link);
            _link.reset();
        }
        if (isKmlFeature(element())) _inherited.pop_back();
    }

    /// What folders, overlays and links say alike.
    void takeFeature()
    {
        KmlReader::Inherited& here = _inherited.back();
        if (element() == "visibility" && isKmlFeature(parent()) && (text() == "0" || text() == "false"))
            here.visible = false;
        const std::string& feature = grandparent();
        if (parent() == "TimeSpan" && isKmlFeature(feature) && element() == "begin") here.begin = text();
        if (parent() == "TimeSpan" && isKmlFeature(feature) && element() == "end") here.end = text();
        if (parent() == "TimeStamp" && isKmlFeature(feature) && element() == "when")
            here.begin = here.end = text();
        if (isAt({"Region", "Lod", "minLodPixels"})) _minimum = numberOf(text()).value_or(0.0);
        if (isAt({"Region", "Lod", "minFadeExtent"})) _fade = numberOf(text()).value_or(0.0);
        if (!isAt({"Region", "Lod"})) return;
        here.pixelsNone = std::clamp(_minimum, 0.0, 1e4);
        here.pixelsFull = std::clamp(_minimum + _fade, here.pixelsNone, 1e4);
        _minimum = _fade = 0.0;
    }

    void takeOverlay()
    {
        Draft& draft = *_overlay;
        const std::string value(text());
        const std::pair<const char*, std::string*> children[] = {{"name", &draft.name},
                                                                 {"color", &draft.color},
                                                                 {"drawOrder", &draft.order},
                                                                 {"altitudeMode", &draft.altitudeMode}};
        for (const auto& [name, target] : children)
            if (isAt({"GroundOverlay", name})) *target = value;
        if (isAt({"GroundOverlay", "Icon", "href"})) draft.href = value;
        const std::pair<const char*, std::string*> edges[] = {{"north", &draft.north},
                                                              {"south", &draft.south},
                                                              {"east", &draft.east},
                                                              {"west", &draft.west},
                                                              {"rotation", &draft.rotation}};
        for (const auto& [name, target] : edges)
            if (isAt({"LatLonBox", name})) *target = value;
        if (isAt({"LatLonQuad", "coordinates"})) draft.quad = value;
    }

    double degrees(const std::string& text, const char* name, double most) const
    {
        const std::optional<double> value = numberOf(text);
        if (!value || std::abs(*value) > most)
            fail(_overlay->line, "the ground overlay's " + std::string(name) + " is \"" + text.substr(0, 40) +
                                     "\"; write degrees, ±" + std::to_string(static_cast<int>(most)) + ".");
        return *value;
    }

    void finishOverlay()
    {
        const Draft& draft = *_overlay;
        if (_content.overlays.size() >= mostOverlays)
            fail(draft.line, "the file has more than " + std::to_string(mostOverlays) +
                                 " ground overlays; split it, or make one raster of them with gdalbuildvrt.");
        KmlReader::Overlay result;
        result.line = draft.line;
        result.href = draft.href;
        KmlOverlay& overlay = result.overlay;
        overlay.name = draft.name;
        overlay.color = colorOf(draft.color);
        if (!draft.order.empty())
            overlay.order = static_cast<int>(std::clamp(numberOf(draft.order).value_or(0.0), -1e9, 1e9));
        const KmlReader::Inherited& inherited = _inherited.back();
        overlay.visible = inherited.visible;
        overlay.pixelsNone = inherited.pixelsNone;
        overlay.pixelsFull = inherited.pixelsFull;
        overlay.begin = inherited.begin;
        overlay.end = inherited.end;
        result.inAir = !draft.altitudeMode.empty() && draft.altitudeMode.rfind("clamp", 0) != 0;
        if (draft.hasQuad)
            overlay.corners = quadOf(draft.quad);
        else if (draft.hasBox)
            overlay.corners = boxOf(draft);
        else
            fail(draft.line, "the ground overlay has neither a LatLonBox nor a gx:LatLonQuad; give it one.");
        _content.overlays.push_back(std::move(result));
    }

    /// aabbggrr.
    osg::Vec4 colorOf(const std::string& text) const
    {
        if (text.empty()) return {1.0f, 1.0f, 1.0f, 1.0f};
        const std::size_t start = text[0] == '#' ? 1 : 0;
        std::uint32_t bits = 0;
        const char* const last = text.data() + text.size();
        const auto [end, failure] = std::from_chars(text.data() + start, last, bits, 16);
        if (failure != std::errc() || end != last || text.size() - start != 8)
            fail(_overlay->line, "the ground overlay's color is \"" + text.substr(0, 40) +
                                     "\"; write aabbggrr in hexadecimal digits.");
        const auto part = [&](unsigned int shift)
        {
            return static_cast<float>(bits >> shift & 0xffu) / 255.0f;
        };
        return {part(0), part(8), part(16), part(24)};
    }

    std::array<osg::Vec2d, 4> boxOf(const Draft& draft) const
    {
        const double north = degrees(draft.north, "north", 90.0), south = degrees(draft.south, "south", 90.0);
        const double west = degrees(draft.west, "west", 360.0);
        double east = degrees(draft.east, "east", 540.0);
        if (east < west) east += 360.0;
        if (!(south < north) || !(west < east) || east - west > 360.0 + 1e-9)
            fail(draft.line,
                 "the ground overlay's box has no area; south must be less than north, and west other "
                 "than east.");
        const double turn =
            draft.rotation.empty() ? 0.0 : osg::DegreesToRadians(degrees(draft.rotation, "rotation", 360.0));
        const osg::Vec2d middle((west + east) / 2.0, (south + north) / 2.0);
        // Turned on the ground, where a degree of longitude is shorter.
        const double narrow = std::max(std::cos(osg::DegreesToRadians(middle.y())), 1e-6);
        std::array<osg::Vec2d, 4> corners = {osg::Vec2d(west, south), osg::Vec2d(east, south),
                                             osg::Vec2d(east, north), osg::Vec2d(west, north)};
        if (turn == 0.0) return corners;
        for (osg::Vec2d& corner : corners)
        {
            const osg::Vec2d d((corner.x() - middle.x()) * narrow, corner.y() - middle.y());
            corner = middle + osg::Vec2d((d.x() * std::cos(turn) - d.y() * std::sin(turn)) / narrow,
                                         d.x() * std::sin(turn) + d.y() * std::cos(turn));
            if (std::abs(corner.y()) > 90.0)
                fail(draft.line,
                     "the ground overlay's turned box reaches beyond a pole; give its corners as a "
                     "gx:LatLonQuad.");
        }
        return corners;
    }

    std::array<osg::Vec2d, 4> quadOf(const std::string& text) const
    {
        std::array<osg::Vec2d, 4> corners;
        std::size_t count = 0;
        std::string_view rest = trimmed(text);
        while (!rest.empty())
        {
            const std::size_t length = std::min(rest.find_first_of(" \t\r\n"), rest.size());
            const std::string tuple(rest.substr(0, length));
            rest = trimmed(rest.substr(length));
            const std::size_t comma = std::min(tuple.find(','), tuple.size());
            const std::size_t second = std::min(tuple.find(',', comma + 1), tuple.size());
            if (count < 4 && comma < tuple.size())
                corners[count].set(degrees(tuple.substr(0, comma), "longitude", 360.0),
                                   degrees(tuple.substr(comma + 1, second - comma - 1), "latitude", 90.0));
            ++count;
        }
        if (count != 4)
            fail(_overlay->line,
                 "the ground overlay's gx:LatLonQuad has " + std::to_string(count) +
                     " corners; write four, LON,LAT each, from the picture's lower left corner "
                     "counter-clockwise.");
        for (osg::Vec2d& corner : corners)
            corner.x() = corners[0].x() + std::remainder(corner.x() - corners[0].x(), 360.0);
        // All four turn the same way.
        int left = 0;
        int right = 0;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const osg::Vec2d a = corners[(i + 1) % 4] - corners[i],
                             b = corners[(i + 2) % 4] - corners[(i + 1) % 4];
            const double turn = a.x() * b.y() - a.y() * b.x();
            left += turn > 0.0 ? 1 : 0;
            right += turn < 0.0 ? 1 : 0;
        }
        if (left != 4 && right != 4)
            fail(_overlay->line,
                 "the ground overlay's gx:LatLonQuad is not convex; write its corners in their order "
                 "around it.");
        return corners;
    }

    std::vector<KmlReader::Inherited> _inherited;
    double _minimum = 0.0, _fade = 0.0;
    std::optional<Draft> _overlay;
    std::optional<KmlReader::Link> _link;
    KmlReader::Content _content;
};

} // namespace

KmlReader::Content KmlReader::read(const std::string& document, const Inherited& inherited)
{
    return Parser(document, inherited).read();
}

} // namespace osgGeoFX
