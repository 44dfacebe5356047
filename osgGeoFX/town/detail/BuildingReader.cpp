// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/BuildingReader.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/CoordinateText.h>
#include <osgGeoFX/geodata/detail/FeatureTags.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/Lengths.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <memory>

namespace osgGeoFX
{

namespace
{

/// The highest that counts as a height; towers have reached 828 m.
constexpr double TALLEST = 1500.0;
/// Less ground than a shed's, square metres: no building.
constexpr double LEAST_AREA = 1.0;
constexpr double LEAST_HEIGHT = 1.0;
constexpr double METRES_PER_STOREY = 3.1;
/// Parts that cover so much of an outline stand in its place.
constexpr double MOST_OF_ALL = 0.5;
/// The most of a ring's points and of a building's rings: more is damage.
constexpr std::size_t MOST_POINTS = 100000, MOST_RINGS = 60000;

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool contains(const std::string& text, std::initializer_list<const char*> words)
{
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// The fields of a layer that tell something, by their numbers; -1 where there is none.
struct Fields
{
    int height = -1, storeys = -1, roof = -1, use = -1, building = -1, tags = -1;
    int part = -1, bottom = -1, lowestStorey = -1;

    bool mayHaveParts() const { return part >= 0 || tags >= 0; }
};

int fieldOf(const OGRFeatureDefn& layer, std::initializer_list<const char*> names)
{
    for (const char* name : names)
        if (const int index = layer.GetFieldIndex(name); index >= 0) return index;
    return -1;
}

/// A number at the beginning of a text, whatever the locale; nothing if there is none. `rest` is what follows it.
std::optional<double> numberAtStart(const std::string& text, std::string& rest)
{
    const std::size_t start = text.find_first_not_of(" \t+");
    if (start == std::string::npos) return {};
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data() + start, text.data() + text.size(), value);
    if (code != std::errc()) return {};
    rest.assign(end, text.data() + text.size());
    return value;
}

/// How much of an outline is below the parts of buildings: their middles and areas.
class PartFinder
{
public:
    void add(const std::vector<Ring>& rings, double area)
    {
        const osg::Vec2d middle = ringMiddle(rings.front());
        _parts.push_back({middle.y(), middle.x(), area});
    }
    /// Ends the adding.
    void finish() { std::sort(_parts.begin(), _parts.end()); }
    /// The area of the parts whose middle is in an outline.
    double areaIn(const std::vector<Ring>& rings) const
    {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const osg::Vec2d& place : rings.front())
        {
            low = std::min(low, place.y());
            high = std::max(high, place.y());
        }
        double sum = 0.0;
        for (auto part =
                 std::lower_bound(_parts.begin(), _parts.end(), std::array<double, 3>{low, -HUGE_VAL, 0.0});
             part != _parts.end() && (*part)[0] <= high; ++part)
            if (isWithin(rings, {(*part)[1], (*part)[0]})) sum += (*part)[2];
        return sum;
    }

private:
    std::vector<std::array<double, 3>> _parts; ///< y, x, and the area
};

class Reader
{
public:
    Reader(const TownOptions& options, const TownGrid& grid, double metresPerUnit, TownSummary& summary,
           const std::function<void(Building&&)>& take)
        : _options(options), _grid(grid), _metresPerUnit(metresPerUnit), _summary(summary), _take(take)
    {
    }

    Fields fieldsOf(const OGRFeatureDefn& layer) const
    {
        Fields fields;
        const auto named = [&](const std::string& name, std::initializer_list<const char*> usual)
        {
            if (name.empty()) return fieldOf(layer, usual);
            const int index = layer.GetFieldIndex(name.c_str());
            if (index < 0)
                throw BuildError(_options.buildings + ": its layer " + std::string(layer.GetName()) +
                                 " has no field \"" + name + "\"; ogrinfo -so -al lists those it has.");
            return index;
        };
        fields.height =
            named(_options.heightField, {"height", "building_height", "building:height", "measuredheight",
                                         "measured_height", "hoehe", "heightroof", "bldg_height"});
        fields.storeys = fieldOf(layer, {"building:levels", "building_levels", "levels", "num_floors",
                                         "floors", "storeys", "stories", "numfloors"});
        fields.roof = named(_options.roofField, {"roof", "roof:shape", "roof_shape", "roof_type"});
        fields.use = fieldOf(layer, {"use", "function", "usage", "class", "fclass", "type"});
        fields.building = layer.GetFieldIndex("building");
        fields.tags = layer.GetFieldIndex("other_tags");
        fields.part = fieldOf(layer, {"building:part", "building_part"});
        fields.bottom = fieldOf(layer, {"min_height", "building:min_height", "minheight"});
        fields.lowestStorey =
            fieldOf(layer, {"building:min_level", "building_min_level", "min_level", "min_floor"});
        return fields;
    }

    /// Looks for parts of buildings before buildings are taken.
    void lookForParts(const OGRFeature& feature, const OGRGeometry& geometry,
                      OGRCoordinateTransformation& toGrid, const Fields& fields)
    {
        std::vector<std::vector<Ring>> outlines;
        if (isPart(feature, fields) && collect(geometry, toGrid, outlines))
            for (const std::vector<Ring>& rings : outlines)
                _parts.add(rings, areaOf(rings));
    }
    void finishParts() { _parts.finish(); }

    void take(const OGRFeature& feature, const OGRGeometry& geometry, OGRCoordinateTransformation& toGrid,
              const Fields& fields)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        const bool polygons = type == wkbPolygon || OGR_GT_IsSubClassOf(type, wkbGeometryCollection);
        const std::string building = text(feature, fields.building);
        // OpenStreetMap's polygons are of all kinds. In other data a field of this name may be a building's name.
        const bool part = isPart(feature, fields);
        const bool other =
            !part && fields.building >= 0 && (building == "no" || (building.empty() && fields.tags >= 0));
        if (!polygons || other)
        {
            ++_summary.otherFeatures;
            return;
        }
        std::vector<std::vector<Ring>> outlines;
        if (!collect(geometry, toGrid, outlines) || outlines.empty())
        {
            ++_summary.leftOut;
            return;
        }
        for (std::vector<Ring>& rings : outlines)
        {
            Building each;
            const double area = areaOf(rings);
            if (!(area >= LEAST_AREA))
            {
                ++_summary.leftOut;
                continue;
            }
            if (!part && _parts.areaIn(rings) >= MOST_OF_ALL * area)
            {
                ++_summary.inParts;
                continue;
            }
            if (part) ++_summary.parts;
            each.rings = std::move(rings);
            if (_repaired) each.notes |= Building::REPAIRED;
            describe(each, feature, fields, area);
            _take(std::move(each));
        }
    }

private:
    static bool isPart(const OGRFeature& feature, const Fields& fields)
    {
        const std::string part = text(feature, fields.part, fields.tags, "building:part");
        const std::string building = text(feature, fields.building);
        return !part.empty() && part != "no" && part != "0" && (building.empty() || building == "no");
    }

    double areaOf(const std::vector<Ring>& rings) const
    {
        const osg::Vec2d metres = _grid.metres(rings.front().front().y());
        double area = 0.0;
        for (const Ring& ring : rings)
            area += ringArea(ring) * metres.x() * metres.y();
        return area;
    }

    static std::string text(const OGRFeature& feature, int field)
    {
        return field >= 0 && feature.IsFieldSetAndNotNull(field) ? lower(feature.GetFieldAsString(field))
                                                                 : std::string();
    }

    /// A field, or a tag of the same meaning.
    static std::string text(const OGRFeature& feature, int field, int tags, const char* tag)
    {
        const std::string own = text(feature, field);
        return own.empty() && tags >= 0 ? tagOf(text(feature, tags), tag) : own;
    }

    /// The polygons of a geometry, valid, as rings in the grid's coordinates. False if any of it cannot be used.
    bool collect(const OGRGeometry& geometry, OGRCoordinateTransformation& toGrid,
                 std::vector<std::vector<Ring>>& outlines)
    {
        if (!isFinite(geometry)) return false;
        std::unique_ptr<OGRGeometry> valid;
        const OGRGeometry* used = &geometry;
        if (!geometry.IsValid())
        {
            valid.reset(geometry.MakeValid());
            if (!valid || valid->IsEmpty()) return false;
            used = valid.get();
        }
        const std::size_t before = outlines.size();
        const bool good = collectValid(*used, toGrid, outlines);
        _repaired = valid && outlines.size() > before;
        return good;
    }

    static bool isFinite(const OGRGeometry& geometry)
    {
        OGREnvelope box;
        geometry.getEnvelope(&box);
        if (!std::isfinite(box.MinX + box.MaxX + box.MinY + box.MaxY)) return false;
        // An envelope passes over numbers that are none.
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbPolygon)
        {
            for (const OGRLinearRing* ring : *geometry.toPolygon())
                for (int i = 0; i < ring->getNumPoints(); ++i)
                    if (!std::isfinite(ring->getX(i)) || !std::isfinite(ring->getY(i))) return false;
            return true;
        }
        if (!OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) return true;
        const OGRGeometryCollection& parts = *geometry.toGeometryCollection();
        return std::all_of(parts.begin(), parts.end(),
                           [](const OGRGeometry* part) { return isFinite(*part); });
    }

    bool collectValid(const OGRGeometry& geometry, OGRCoordinateTransformation& toGrid,
                      std::vector<std::vector<Ring>>& outlines)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbPolygon)
        {
            std::vector<Ring> rings;
            for (const OGRLinearRing* each : *geometry.toPolygon())
            {
                Ring ring;
                const bool outline = rings.empty();
                if (!ringOf(*each, outline, toGrid, ring)) return false;
                if (ring.size() < 3)
                {
                    // An outline without an area; a courtyard of that kind does no harm.
                    if (outline) return false;
                    continue;
                }
                rings.push_back(std::move(ring));
            }
            if (rings.size() > MOST_RINGS) return false;
            if (!rings.empty()) outlines.push_back(std::move(rings));
            return true;
        }
        if (!OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) return true;
        bool good = true;
        for (const OGRGeometry* part : *geometry.toGeometryCollection())
            good = collectValid(*part, toGrid, outlines) && good;
        return good;
    }

    /// A ring in the grid's coordinates, without points that lie on a line or on each other.
    bool ringOf(const OGRLinearRing& source, bool outline, OGRCoordinateTransformation& toGrid, Ring& ring)
    {
        const auto count = static_cast<std::size_t>(std::max(0, source.getNumPoints()));
        if (count > MOST_POINTS) return false;
        _x.resize(count);
        _y.resize(count);
        _placed.resize(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            _x[i] = source.getX(static_cast<int>(i));
            _y[i] = source.getY(static_cast<int>(i));
        }
        toGrid.Transform(count, _x.data(), _y.data(), nullptr, nullptr, _placed.data());
        Ring whole;
        for (std::size_t i = 0; i < count; ++i)
        {
            if (!_placed[i] || !std::isfinite(_x[i]) || !std::isfinite(_y[i])) return false;
            const osg::Vec2d place = osg::Vec2d(_x[i], _y[i]) * _metresPerUnit;
            if (_grid.geocentric() && std::abs(place.y()) > 90.0) return false;
            // Relative to the outline's first point, so that no outline goes around the globe.
            if (outline && whole.empty()) _about = _grid.turned(place);
            whole.push_back(_grid.turned(place, _about));
        }
        // The last point repeats the first.
        if (whole.size() > 1 && whole.front() == whole.back()) whole.pop_back();
        if (whole.size() < 3) return true;
        const osg::Vec2d metres = _grid.metres(whole.front().y());
        // On a line within two centimetres.
        constexpr double straight = 0.02;
        for (bool changed = true; changed && whole.size() > 3;)
        {
            changed = false;
            for (std::size_t i = 0; i < whole.size() && whole.size() > 3; ++i)
            {
                const osg::Vec2d& a = whole[(i + whole.size() - 1) % whole.size()];
                const osg::Vec2d& c = whole[(i + 1) % whole.size()];
                const osg::Vec2d ab = osg::componentMultiply(whole[i] - a, metres),
                                 ac = osg::componentMultiply(c - a, metres);
                const double length = ac.length();
                const double off =
                    length > straight ? std::abs(ab.x() * ac.y() - ab.y() * ac.x()) / length : ab.length();
                const double along = length > straight ? (ab * ac) / length : 0.0;
                if (off > straight || along < -straight || along > length + straight) continue;
                whole.erase(whole.begin() + static_cast<std::ptrdiff_t>(i));
                changed = true;
            }
        }
        if ((ringArea(whole) > 0.0) != outline) std::reverse(whole.begin(), whole.end());
        ring = std::move(whole);
        return true;
    }

    void describe(Building& building, const OGRFeature& feature, const Fields& fields, double area)
    {
        const std::optional<double> height = heightOf(feature, fields, building);
        const std::optional<double> storeys = storeysOf(feature, fields);
        const std::string use = text(feature, fields.use) + " " + text(feature, fields.building);
        const std::string roof = text(feature, fields.roof, fields.tags, "roof:shape");
        if (height)
            building.height = *height;
        else if (storeys)
        {
            building.height = METRES_PER_STOREY * *storeys + 1.0;
            building.notes |= Building::BY_STOREYS;
        }
        else
        {
            // Sheds, houses, blocks of flats, halls.
            building.height = area < 40.0 ? 3.0 : area < 300.0 ? 6.0 : area < 1200.0 ? 10.0 : 12.0;
            building.notes |= Building::BY_AREA;
        }
        takeBottom(building, feature, fields);
        building.use = useOf(use, building.height, area);
        const bool rectangle = building.rings.size() == 1 && building.rings.front().size() == 4;
        if (roof.empty() || roof == "unknown")
            building.gabled = rectangle && building.use == BuildingUse::HOUSE && building.height < 12.0;
        else
            building.gabled = contains(roof, {"gable", "pitch", "hip", "saddle", "sattel"});
        if (building.gabled && rectangle) building.notes |= Building::GABLED;
    }

    /// The underside of a part above the ground. One that is not below the roof is no use.
    void takeBottom(Building& building, const OGRFeature& feature, const Fields& fields) const
    {
        const std::optional<double> told = lengthOf(feature, fields.bottom, fields.tags, "min_height");
        const std::string words = text(feature, fields.lowestStorey, fields.tags, "building:min_level");
        std::string rest;
        const double bottom = told ? *told : METRES_PER_STOREY * numberAtStart(words, rest).value_or(0.0);
        if (!(bottom > 0.0 && bottom <= TALLEST)) return;
        if (building.notes & Building::BY_AREA) building.height += bottom;
        if (bottom <= building.height - LEAST_HEIGHT) building.bottom = bottom;
    }

    /// A length, metres; empty if there is none that is a number.
    std::optional<double> lengthOf(const OGRFeature& feature, int field, int tags, const char* tag) const
    {
        const std::string words = text(feature, field, tags, tag);
        // Numbers as they are, without a detour by text.
        const OGRFieldType type = field >= 0 ? feature.GetFieldDefnRef(field)->GetType() : OFTString;
        const double metresPerPlain = _options.unit == HeightUnit::FEET ? Lengths::METRES_PER_FOOT : 1.0;
        if ((type == OFTReal || type == OFTInteger || type == OFTInteger64) &&
            feature.IsFieldSetAndNotNull(field))
            return feature.GetFieldAsDouble(field) * metresPerPlain;
        return Lengths::read(words, metresPerPlain);
    }

    std::optional<double> heightOf(const OGRFeature& feature, const Fields& fields, Building& building) const
    {
        if (text(feature, fields.height, fields.tags, "height").empty()) return {};
        const std::optional<double> height = lengthOf(feature, fields.height, fields.tags, "height");
        if (height && std::isfinite(*height) && *height >= LEAST_HEIGHT && *height <= TALLEST) return height;
        building.notes |= Building::BAD_HEIGHT;
        return {};
    }

    static std::optional<double> storeysOf(const OGRFeature& feature, const Fields& fields)
    {
        const std::string words = text(feature, fields.storeys, fields.tags, "building:levels");
        std::string rest;
        const double storeys = numberAtStart(words, rest).value_or(0.0);
        if (!(storeys >= 0.5 && storeys <= 250.0)) return {};
        return storeys;
    }

    static BuildingUse useOf(const std::string& words, double height, double area)
    {
        const bool tall = height > 55.0;
        if (contains(words,
                     {"industrial", "warehouse", "factory", "hangar", "hall", "storage", "garage", "church"}))
            return BuildingUse::HALL;
        if (contains(words, {"office", "commercial", "retail", "civic", "public", "hospital", "school",
                             "university"}))
            return tall ? BuildingUse::TOWER : BuildingUse::OFFICE;
        if (contains(words, {"apartment", "flats", "hotel", "dormitory"})) return BuildingUse::FLATS;
        if (contains(words, {"house", "detached", "bungalow", "terrace", "hut", "farm", "cabin"}))
            return BuildingUse::HOUSE;
        if (height < 10.0 && area < 450.0) return BuildingUse::HOUSE;
        if (height < 16.0 && area > 2500.0) return BuildingUse::HALL;
        return height > 110.0 ? BuildingUse::TOWER : BuildingUse::FLATS;
    }

    const TownOptions& _options;
    const TownGrid& _grid;
    const double _metresPerUnit;
    TownSummary& _summary;
    const std::function<void(Building&&)>& _take;
    PartFinder _parts;
    std::vector<double> _x, _y;
    std::vector<int> _placed;
    bool _repaired = false; ///< whether the outlines in work were mended
    osg::Vec2d _about;      ///< the first point of the outline in work
};

} // namespace

void readBuildings(const TownOptions& options, const TownGrid& grid, const std::string& wkt,
                   TownSummary& summary, const TownProgress& progress,
                   const std::function<void(Building&&)>& take)
{
    initialiseGdal();
    OGRSpatialReference target;
    if (!setCoordinateSystem(target, wkt))
        throw BuildError(options.database +
                         "/terrain.osgb: its coordinate system cannot be read; build the database again.");
    target.StripVertical();
    const double metresPerUnit = grid.geocentric() ? 1.0 : target.GetLinearUnits();
    const DatasetPtr dataset = openVectors(options.buildings);
    Reader reader(options, grid, metresPerUnit, summary, take);
    bool any = false;
    std::uint64_t done = 0;
    const auto mayHavePolygons = [&](OGRLayer& layer)
    {
        const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
        return type == wkbUnknown || type == wkbPolygon || type == wkbMultiPolygon ||
               type == wkbGeometryCollection || type == wkbCurvePolygon || type == wkbMultiSurface ||
               !options.layer.empty();
    };
    // Parts first, for they replace outlines, wherever these stand in the file.
    forEachLayer(*dataset, options.layer, options.buildings,
                 [&](OGRLayer& layer)
                 {
                     if (!mayHavePolygons(layer)) return;
                     const Fields fields = reader.fieldsOf(*layer.GetLayerDefn());
                     if (!fields.mayHaveParts()) return;
                     const GdalErrorScope quiet;
                     std::string filter;
                     if (fields.part >= 0)
                         filter = std::string("\"") +
                                  layer.GetLayerDefn()->GetFieldDefn(fields.part)->GetNameRef() +
                                  "\" IS NOT NULL";
                     if (fields.tags >= 0)
                         filter +=
                             std::string(filter.empty() ? "" : " OR ") + "other_tags LIKE '%building:part%'";
                     layer.SetAttributeFilter(filter.c_str());
                     forEachFeature(
                         layer, target, options.buildings,
                         [&](const OGRFeature& feature, const OGRGeometry& geometry,
                             OGRCoordinateTransformation& toGrid)
                         { reader.lookForParts(feature, geometry, toGrid, fields); },
                         LongLines::KEPT);
                     layer.SetAttributeFilter(nullptr);
                 });
    reader.finishParts();
    forEachLayer(*dataset, options.layer, options.buildings,
                 [&](OGRLayer& layer)
                 {
                     if (!mayHavePolygons(layer)) return;
                     any = true;
                     const Fields fields = reader.fieldsOf(*layer.GetLayerDefn());
                     const GIntBig known = layer.GetFeatureCount(TRUE);
                     const std::uint64_t total =
                         done + static_cast<std::uint64_t>(std::max<GIntBig>(known, 0));
                     forEachFeature(
                         layer, target, options.buildings,
                         [&](const OGRFeature& feature, const OGRGeometry& geometry,
                             OGRCoordinateTransformation& toGrid)
                         {
                             // What GEOS says of a damaged outline is no failure of the file.
                             const GdalErrorScope quiet;
                             reader.take(feature, geometry, toGrid, fields);
                             constexpr std::uint64_t step = 1000;
                             if (++done % step == 0 && progress &&
                                 !progress(std::min(done, total), total, "buildings"))
                                 throw BuildError(options.database +
                                                  ": the town was stopped; the database is as it was.");
                         },
                         LongLines::KEPT);
                 });
    if (!any)
        throw BuildError(options.buildings +
                         ": it has no layer of polygons; name another file, or check it with ogrinfo.");
}

} // namespace osgGeoFX
