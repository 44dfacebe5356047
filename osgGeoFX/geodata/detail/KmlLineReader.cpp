// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/KmlLineReader.h>

#include <osgGeoFX/geodata/detail/KmlStream.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace osgGeoFX
{

namespace
{

class Parser : public KmlStream
{
public:
    Parser(const std::string& document, std::size_t mostPlaces) : KmlStream(document), _mostPlaces(mostPlaces)
    {
    }

    KmlLines read()
    {
        parse();
        KmlLines result;
        result.links = std::move(_networkLinks);
        result.places = _places;
        result.bytes = bytes();
        for (Line& line : _lines)
        {
            if (!line.route.color) line.route.color = colorOf(line.style, 0);
            result.routes.push_back(std::move(line.route));
        }
        return result;
    }

private:
    struct Line
    {
        RoutePath route;
        std::string style; ///< the id of a shared one
    };

    std::size_t longestText() const override
    {
        // Coordinates come in one text, as long as the document at most.
        return isAt({"LineString", "coordinates"}) ? std::size_t{1} << 28 : KmlStream::longestText();
    }

    static bool isContainer(const std::string& name)
    {
        return name == "Document" || name == "Folder" || name == "Placemark" || name == "NetworkLink";
    }

    void begin() override
    {
        if (isContainer(element())) _visible.push_back(_visible.back());
        if (element() == "Placemark")
        {
            _first = _lines.size();
            _name.clear();
            _styleUrl.clear();
            _placemarkColor.reset();
        }
        if (element() == "LineString" || element() == "Track")
        {
            _route = RoutePath();
            if (parent() == "MultiTrack") _route->altitude = _tracksAltitude;
        }
        if (element() == "MultiTrack") _tracksAltitude = RoutePath::CLAMPED;
        if (element() == "Style" || element() == "StyleMap") _styleId = attribute("id");
    }

    void end() override
    {
        if (element() == "visibility" && isContainer(parent()) && (text() == "0" || text() == "false"))
            _visible.back() = false;
        if (isAt({"Placemark", "name"})) _name = text();
        if (isAt({"Placemark", "styleUrl"})) _styleUrl = text();
        if (isAt({"LineStyle", "color"})) takeColor();
        if (isAt({"Pair", "key"})) _key = text();
        if (isAt({"StyleMap", "Pair", "styleUrl"}) && _key == "normal") _links["#" + _styleId] = text();
        if (isAt({"NetworkLink", "Link", "href"}) || isAt({"NetworkLink", "Url", "href"}))
            if (_visible.back())
            {
                if (_networkLinks.size() >= mostKmlLinks) fail(line(), tooManyLinks);
                _networkLinks.emplace_back(text());
            }
        if (_route) takeGeometry();
        if (isAt({"MultiTrack", "altitudeMode"})) _tracksAltitude = altitude();
        if (element() == "Placemark") finishPlacemark();
        if (isContainer(element())) _visible.pop_back();
    }

    RoutePath::Altitude altitude() const
    {
        if (text() == "absolute") return RoutePath::ABSOLUTE;
        return text() == "relativeToGround" ? RoutePath::ABOVE_GROUND : RoutePath::CLAMPED;
    }

    void takeGeometry()
    {
        if (element() == "altitudeMode") _route->altitude = altitude();
        if (element() == "extrude") _route->extruded = text() == "1" || text() == "true";
        if (isAt({"LineString", "coordinates"})) takeCoordinates(text());
        // An empty one is a moment without a place.
        if (isAt({"Track", "coord"}) && !text().empty()) takeTuple(text(), " \t\r\n");
        if (element() != "LineString" && element() != "Track") return;
        if (_route->altitude == RoutePath::CLAMPED)
            for (osg::Vec3d& place : _route->places)
                place.z() = 0.0;
        if (_visible.back() && _route->places.size() > 1) _lines.push_back({std::move(*_route), {}});
        _route.reset();
    }

    void finishPlacemark()
    {
        for (std::size_t i = _first; i < _lines.size(); ++i)
        {
            _lines[i].route.name = _name;
            _lines[i].route.color = _placemarkColor;
            _lines[i].style = _styleUrl;
        }
    }

    /// Some write a space behind the commas, too.
    void takeCoordinates(std::string_view rest)
    {
        while (!(rest = trimmed(rest)).empty())
        {
            const char* const spaces = " \t\r\n";
            std::size_t length = std::min(rest.find_first_of(spaces), rest.size());
            while (length < rest.size() && rest[length - 1] == ',')
            {
                const std::size_t next = std::min(rest.find_first_not_of(spaces, length), rest.size());
                length = std::min(rest.find_first_of(spaces, next), rest.size());
            }
            takeTuple(rest.substr(0, length), ",");
            rest.remove_prefix(length);
        }
    }

    /// A place. Some write commas between places, too; then each has three numbers.
    void takeTuple(std::string_view tuple, const char* separators)
    {
        std::string_view rest = tuple;
        do
        {
            osg::Vec3d place;
            int count = 0;
            for (; !rest.empty() && count < 3; ++count)
            {
                const std::size_t length = std::min(rest.find_first_of(separators), rest.size());
                const std::optional<double> value = numberOf(rest.substr(0, length));
                if (!value) break;
                place[count] = *value;
                rest.remove_prefix(std::min(length + 1, rest.size()));
                rest = trimmed(rest);
            }
            if (count < 2 || std::abs(place.x()) > 360.0 || std::abs(place.y()) > 90.0)
                fail(line(),
                     "the place \"" + std::string(tuple.substr(0, 60)) +
                         "\" of a line is none; write longitude, latitude and height, degrees and metres.");
            take(place);
            if (count < 3) return;
        } while (!rest.empty() && *separators == ',');
    }

    void take(const osg::Vec3d& place)
    {
        if (++_places > _mostPlaces)
            fail(line(), "with this place, the lines of the file and of what it links have more than ten "
                         "million; simplify "
                         "them with ogr2ogr -simplify.");
        _route->places.push_back(place);
    }

    /// aabbggrr; another text is no color.
    void takeColor()
    {
        const std::string_view digits = text();
        std::uint32_t bits = 0;
        const char* const last = digits.data() + digits.size();
        const auto [end, failure] = std::from_chars(digits.data(), last, bits, 16);
        if (failure != std::errc() || end != last || digits.size() != 8) return;
        const auto part = [&](unsigned int shift)
        {
            return static_cast<float>(bits >> shift & 0xffu) / 255.0f;
        };
        const osg::Vec4 color(part(0), part(8), part(16), part(24));
        if (isAt({"Placemark", "Style", "LineStyle", "color"}))
            _placemarkColor = color;
        else
            _colors["#" + _styleId] = color;
    }

    std::optional<osg::Vec4> colorOf(const std::string& style, int depth) const
    {
        if (const auto found = _colors.find(style); found != _colors.end()) return found->second;
        const auto link = _links.find(style);
        return link == _links.end() || depth > 8 ? std::nullopt : colorOf(link->second, depth + 1);
    }

    std::vector<bool> _visible = {true};
    std::optional<RoutePath> _route;
    RoutePath::Altitude _tracksAltitude = RoutePath::CLAMPED; ///< of the present gx:MultiTrack
    std::vector<Line> _lines;
    std::size_t _first = 0; ///< of the present placemark's lines
    const std::size_t _mostPlaces;
    std::size_t _places = 0;
    std::string _name, _styleUrl, _styleId, _key;
    std::optional<osg::Vec4> _placemarkColor;
    std::map<std::string, osg::Vec4> _colors;
    std::map<std::string, std::string> _links; ///< from a StyleMap's id to its style's
    std::vector<std::string> _networkLinks;
};

} // namespace

KmlLines readKmlLines(const std::string& document, std::size_t mostPlaces)
{
    return Parser(document, mostPlaces).read();
}

} // namespace osgGeoFX
