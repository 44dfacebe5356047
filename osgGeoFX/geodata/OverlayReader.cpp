// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/OverlayReader.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/KmlOverlays.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/SldColors.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/geodata/TiledVectors.h>
#include <osgGeoFX/geodata/detail/CubeFace.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/raster/ColorRampFile.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace osgGeoFX
{

namespace
{

constexpr double earthRadius = 6371e3; // metres
constexpr double farthestIfNeeded = 80.0;
constexpr std::size_t mostFrames = 7;
constexpr std::size_t mostFramesAround = 9; ///< of three texture units each; with six of one raster

/// Of arc between two places, degrees each; radians.
double arc(const osg::Vec2d& a, const osg::Vec2d& b)
{
    const double latitude = osg::DegreesToRadians(b.y() - a.y()) / 2.0;
    const double longitude = osg::DegreesToRadians(b.x() - a.x()) / 2.0;
    const double h = std::pow(std::sin(latitude), 2.0) + std::cos(osg::DegreesToRadians(a.y())) *
                                                             std::cos(osg::DegreesToRadians(b.y())) *
                                                             std::pow(std::sin(longitude), 2.0);
    return 2.0 * std::asin(std::min(1.0, std::sqrt(h)));
}

class Work
{
public:
    Work(const std::string& file, const OverlayReader::Options& options, const OverlayReader& reader)
        : _file(file), _raster(file), _options(options), _globe(reader.globe), _wkt(reader.wkt),
          frames(reader.frames), _bands(options.bands)
    {
    }

    void read()
    {
        if (!_options.layer.empty()) return readLayer();
        bool isNone = false;
        try
        {
            if (KmlOverlays::isKml(_file))
                readKml(isNone);
            else
                readRaster();
        }
        catch (const BuildError& fault)
        {
            const bool isKml = KmlOverlays::isKml(_file);
            if ((isKml && !isNone) || !TiledVectors::isVectors(_file)) throw;
            // Left-out pictures say more than that there is nothing else.
            readVectors(isKml && !notices.empty() ? fault.what() : "");
        }
    }

private:
    /// The layer of vector data, or the variable of a raster.
    void readLayer()
    {
        try
        {
            readVectors();
        }
        catch (const BuildError&)
        {
            if (TiledVectors::isVectors(_file) || !RasterFile::isRaster(_file)) throw;
            _raster += ":" + _options.layer;
            readRaster();
        }
    }

    const std::string& _file;
    std::string _raster; ///< the file, or a variable of it
    const OverlayReader::Options& _options;
    const bool _globe;
    const std::string& _wkt;

public:
    std::vector<LocalOrigin> frames;
    std::vector<GroundOverlay> overlays;
    std::vector<std::string> notices;
    std::vector<std::string> files;

private:
    MappingFrame frameOf(std::size_t index) const
    {
        MappingFrame frame;
        frame.globe = _globe;
        frame.wkt = _wkt;
        if (index < frames.size()) frame.origin = frames[index];
        return frame;
    }

    bool isTooLarge(const GroundReach& reach) const { return _globe && reach.radius > CubeFace::leastRadius; }

    /// Throws BuildError where there are too many frames.
    std::size_t frameFor(const GroundReach& reach, const std::string& name)
    {
        std::string error;
        if (!_globe)
        {
            if (!frames.empty()) return 0;
            MappingFrame frame = frameOf(0);
            if (!OverlayRaster::moveToMiddle(reach, name, frame, error)) throw BuildError(error);
            frames.push_back(frame.origin);
            return 0;
        }
        // A quarter of a texel, of floats with 24 bits.
        const double sharp = reach.texel * 4194304.0 / earthRadius;
        std::size_t nearest = 0;
        double least = 1e30;
        for (std::size_t i = 0; i < frames.size(); ++i)
        {
            const osg::Vec2d origin(osg::RadiansToDegrees(frames[i].longitude),
                                    osg::RadiansToDegrees(frames[i].latitude));
            const double distance = arc(origin, reach.middle) + reach.radius;
            if (distance <= std::min(CubeFace::leastRadius, std::max(sharp, reach.radius))) return i;
            if (distance >= least) continue;
            least = distance;
            nearest = i;
        }
        if (frames.size() < mostFrames)
        {
            MappingFrame frame = frameOf(frames.size());
            OverlayRaster::moveToMiddle(reach, name, frame, error);
            frames.push_back(frame.origin);
            return frames.size() - 1;
        }
        if (least > osg::DegreesToRadians(farthestIfNeeded))
            throw BuildError(name +
                             ": it lies too far from all other rasters, which share seven frames; show "
                             "fewer at once.");
        return nearest;
    }

    void add(GroundOverlay overlay)
    {
        count(*overlay.layer);
        overlays.push_back(std::move(overlay));
    }

    /// Several overlays may share a layer.
    void count(const DataLayer& layer)
    {
        if (!_counted.insert(&layer).second) return;
        const osg::Image& image = *layer.getImage();
        _texels += static_cast<double>(image.s()) * image.t();
    }

    /// `isNone`: whether it has no overlays or all are left out, and no other fault.
    void readKml(bool& isNone)
    {
        std::vector<KmlOverlay> found;
        std::string error;
        if (!KmlOverlays::read(_file, _options.allowOutside, found, notices, error, &files, &isNone))
            throw BuildError(error);
        OverlayRaster::Options options{_options.maxSide, _options.allowOutside};
        options.bands = _options.bands.value_or(RasterBands());
        OverlayRaster::Pictures shared;
        std::map<std::string, std::size_t> uses;
        for (const KmlOverlay& each : found)
            ++uses[each.image];
        std::size_t done = 0, leftOut = 0;
        std::string firstFault;
        for (const KmlOverlay& each : found)
        {
            if (_texels > _options.maxTexels)
            {
                notices.push_back(_file + ": " + std::to_string(found.size() - done) + " of its " +
                                  std::to_string(found.size()) +
                                  " ground overlays are left out, since the others have more than " +
                                  std::to_string(static_cast<long>(_options.maxTexels)) + " texels.");
                return;
            }
            ++done;
            const std::size_t overlaysBefore = overlays.size(), framesBefore = frames.size();
            OverlayRaster::Pictures* const own = uses[each.image] > 1 ? &shared : nullptr;
            options.pictures = _options.pictures ? _options.pictures : own;
            try
            {
                addKml(each, options);
            }
            catch (const BuildError& fault)
            {
                overlays.erase(overlays.begin() + static_cast<std::ptrdiff_t>(overlaysBefore),
                               overlays.end());
                frames.resize(framesBefore);
                if (firstFault.empty()) firstFault = fault.what();
                constexpr std::size_t mostNotices = 20;
                if (++leftOut > mostNotices) continue;
                notices.push_back(std::string(fault.what()) + " The ground overlay is left out." +
                                  (leftOut == mostNotices ? " So are others, which are not named." : ""));
            }
        }
        if (overlays.empty() && !firstFault.empty())
        {
            isNone = true;
            throw BuildError(firstFault);
        }
    }

    void addKml(const KmlOverlay& each, const OverlayRaster::Options& options)
    {
        std::string error;
        const std::optional<GroundReach> reach = OverlayRaster::reachOf(each, options, error);
        if (!reach) throw BuildError(error);
        GroundOverlay overlay;
        overlay.name = each.name.empty() ? std::filesystem::path(each.image).filename().string() : each.name;
        overlay.opacity = static_cast<double>(each.color.a());
        overlay.order = each.order;
        overlay.visible = each.visible;
        overlay.pixelsNone = each.pixelsNone;
        overlay.pixelsFull = each.pixelsFull;
        const auto take = [&](const MappingFrame& frame, const std::optional<MappingRaster::Window>& window)
        {
            OverlayRaster::Options how = options;
            how.window = window;
            const std::optional<OverlayRaster> raster = OverlayRaster::read(each, frame, how, error);
            if (!raster) throw BuildError(error);
            overlay.layer = raster->layer;
            overlay.corners = raster->corners;
        };
        addParts(*reach, "The ground overlay \"" + each.name + "\" of " + _file, overlay, take);
        // Those of this file alone end with the reading.
        if (!_options.pictures) return;
        const auto kept = _options.pictures->find({each.image, options.maxSide});
        if (kept != _options.pictures->end()) count(*kept->second);
    }

    using Take = std::function<void(const MappingFrame&, const std::optional<MappingRaster::Window>&)>;

    /// Around ground that is smaller than this, metres, a raster around the globe is cut out.
    static constexpr double mostReach = 2e6, leastReach = 1e3;

    bool hasSmallGround() const { return _options.ground.valid() && _options.ground.radius() < mostReach; }

    LocalOrigin middleOfGround() const
    {
        const osg::EllipsoidModel earth;
        const osg::Vec3d& middle = _options.ground.center();
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        earth.convertXYZToLatLongHeight(middle.x(), middle.y(), middle.z(), latitude, longitude, height);
        return LocalOrigin::onGlobe(longitude, latitude);
    }

    /// The origin of a frame that there is, if ground around a place is near to it, else the place; and how far the place is from it, metres.
    std::pair<LocalOrigin, double> originNear(const LocalOrigin& place) const
    {
        const auto degrees = [](const LocalOrigin& origin)
        {
            return osg::Vec2d(osg::RadiansToDegrees(origin.longitude),
                              osg::RadiansToDegrees(origin.latitude));
        };
        for (const LocalOrigin& origin : frames)
        {
            const double distance = arc(degrees(origin), degrees(place)) * earthRadius;
            if (distance + _options.ground.radius() < mostReach && !CubeFace::isOrigin(origin))
                return {origin, distance};
        }
        return {place, 0.0};
    }

    /// TiledRaster's reach for a part of a raster around the globe; 0 for a sixth.
    static double reachAround(const MappingFrame& frame, const std::optional<MappingRaster::Window>& window)
    {
        return window && !CubeFace::isOrigin(frame.origin) ? window->high.x() : 0.0;
    }

    /// Adds the overlay, which `take` fills for a frame. A raster that reaches around the globe becomes six parts, or, if `mayBeCut`, one around
    /// the ground where that is small.
    void addParts(const GroundReach& reach, const std::string& name, GroundOverlay& overlay, const Take& take,
                  bool mayBeCut = false)
    {
        if (!isTooLarge(reach))
        {
            overlay.frame = frameFor(reach, name);
            take(frameOf(overlay.frame), std::nullopt);
            add(overlay);
            return;
        }
        if (mayBeCut && hasSmallGround())
        {
            const auto [origin, distance] = originNear(middleOfGround());
            MappingFrame frame = frameOf(frames.size());
            frame.origin = origin;
            const double half = std::max(1.05 * (distance + _options.ground.radius()), leastReach);
            take(frame, MappingRaster::Window{{-half, -half}, {half, half}, reach.texel});
            overlay.frame = frameAt(origin, name);
            add(overlay);
            return;
        }
        // As many texels as a face has room for.
        const double coarsest =
            2.0 * osg::WGS_84_RADIUS_EQUATOR * std::sin(osg::PI_4) / std::max(1, _options.maxSide - 8);
        MappingRaster::Window window = CubeFace::window(std::max(reach.texel, coarsest));
        window.texel = reach.texel;
        for (const LocalOrigin& origin : CubeFace::origins())
        {
            if (!CubeFace::mayHave(origin, _options.ground)) continue;
            MappingFrame frame = frameOf(frames.size());
            frame.origin = origin;
            take(frame, window);
            if (!CubeFace::cut(*overlay.layer->getImage(), window, std::abs(origin.latitude) > 1.0)) continue;
            overlay.frame = frameAt(origin, name);
            add(overlay);
        }
    }

    std::size_t frameAt(const LocalOrigin& origin, const std::string& name)
    {
        for (std::size_t i = 0; i < frames.size(); ++i)
            if (frames[i].longitude == origin.longitude && frames[i].latitude == origin.latitude) return i;
        if (frames.size() >= mostFramesAround)
            throw BuildError(
                name +
                ": it reaches around the globe, and there are too many rasters elsewhere beside it; name "
                "it first, or show fewer at once.");
        frames.push_back(origin);
        return frames.size() - 1;
    }

    /// What an SLD file says of the bands.
    void readSld()
    {
        if (_options.colors.empty() || !SldColors::isSld(_options.colors)) return;
        std::string error;
        const std::optional<SldColors> all = SldColors::readAll(_options.colors, error);
        if (!all) throw BuildError(error);
        _sld = *all;
        if (!_sld.hasBands) return;
        if (!_sld.table)
            _kind = DataLayer::COLOR;
        else
            _kind = _sld.table->getMode() == ColorTable::EXACT ? DataLayer::CLASS : DataLayer::VALUE;
        if (!_bands) _bands = RasterBands();
        for (std::size_t i = 0; i < _bands->channels.size(); ++i)
        {
            RasterBands::Channel& channel = _bands->channels[i];
            const RasterBands::Channel& other = _sld.bands.channels[i];
            if (channel.band == 0) channel.band = other.band;
            if (!channel.range) channel.range = other.range;
        }
    }

    void readRaster()
    {
        readSld();
        std::string error;
        GroundOverlay overlay;
        if (!_sld.table) overlay.opacity = _sld.opacity;
        overlay.name = std::filesystem::path(_raster).filename().string();
        GroundReach reach;
        if (_globe)
        {
            const std::optional<GroundReach> found = OverlayRaster::reachOf(_raster, error);
            if (!found) throw BuildError(error);
            reach = *found;
        }
        else if (frames.empty())
        {
            MappingFrame frame = frameOf(0);
            if (!MappingRaster::moveToMiddle(_raster, frame, error)) throw BuildError(error);
            frames.push_back(frame.origin);
        }
        const std::size_t before = overlays.size();
        const auto take = [&](const MappingFrame& frame, const std::optional<MappingRaster::Window>& window)
        {
            MappingRaster::Options options{_kind, _options.maxSide, window, _bands.value_or(RasterBands())};
            // Faces lie over each other by two texels, which a coarse raster would show.
            constexpr int leastSide = 1024;
            if (window)
                options.window->texel =
                    std::min(window->texel, (window->high.x() - window->low.x()) / leastSide);
            if (_options.paged) overlay.tiles = tilesIn(frame, reachAround(frame, window), options.maxSide);
            const std::optional<MappingRaster> raster = MappingRaster::read(_raster, frame, options, error);
            if (!raster) throw BuildError(error);
            const osg::Vec2d& low = raster->low;
            const osg::Vec2d& high = raster->high;
            overlay.layer = raster->layer;
            overlay.corners = {low, osg::Vec2d(high.x(), low.y()), high, osg::Vec2d(low.x(), high.y())};
            overlay.lowest = raster->lowest;
            overlay.highest = raster->highest;
        };
        addParts(reach, _raster, overlay, take, true);
        giveColors(before);
        notices.insert(notices.end(), _sld.notices.begin(), _sld.notices.end());
    }

    /// `otherwise`: the fault if there are none; empty for their own.
    void readVectors(const std::string& otherwise = {})
    {
        std::string error;
        const std::optional<TiledVectors> vectors =
            TiledVectors::read(_file, {_options.layer, _options.style, _options.allowOutside}, error);
        if (!vectors) throw BuildError(otherwise.empty() ? error : otherwise);
        notices.insert(notices.end(), vectors->notices().begin(), vectors->notices().end());
        const GroundReach reach{vectors->middle(), vectors->radius(), vectors->texel()};
        if (!_globe && frames.empty()) frames.push_back(originFor(*vectors));
        if (vectors->hasShapes())
        {
            GroundOverlay overlay;
            overlay.name = std::filesystem::path(_file).filename().string();
            const auto take =
                [&](const MappingFrame& frame, const std::optional<MappingRaster::Window>& window)
            {
                overlay.tiles = vectors->tiles(frame, window, error);
                if (!overlay.tiles) throw BuildError(error);
                setCoarse(overlay);
            };
            addParts(reach, _file, overlay, take);
        }
        for (const TiledVectors::Symbol& symbol : vectors->symbols())
            addSymbol(symbol, reach);
    }

    /// On a plane: the middle of what its projection has a place for.
    LocalOrigin originFor(const TiledVectors& vectors) const
    {
        std::string error;
        MappingFrame frame = frameOf(0);
        if (vectors.hasShapes())
        {
            const osg::ref_ptr<RasterTiles> tiles = vectors.tiles(frame, std::nullopt, error);
            if (!tiles) throw BuildError(error);
            return LocalOrigin::onPlane((tiles->low() + tiles->high()) / 2.0);
        }
        const GroundReach reach{vectors.middle(), vectors.radius(), vectors.texel()};
        if (!OverlayRaster::moveToMiddle(reach, _file, frame, error)) throw BuildError(error);
        return frame.origin;
    }

    static void setCoarse(GroundOverlay& overlay)
    {
        constexpr int coarse = 512;
        const osg::Vec2d low = overlay.tiles->low(), high = overlay.tiles->high();
        const osg::Vec2d size = high - low;
        const double texel = std::max(size.x(), size.y()) / coarse;
        const auto texels = [&](double metres)
        {
            return std::clamp(static_cast<int>(std::lround(metres / texel)), 1, coarse);
        };
        std::string error;
        const osg::ref_ptr<osg::Image> image =
            overlay.tiles->read(low, high, texels(size.x()), texels(size.y()), error);
        if (!image) throw BuildError(error);
        overlay.layer = new DataLayer(image);
        overlay.corners = {low, osg::Vec2d(high.x(), low.y()), high, osg::Vec2d(low.x(), high.y())};
    }

    void addSymbol(const TiledVectors::Symbol& symbol, const GroundReach& reach)
    {
        GroundOverlay overlay;
        overlay.name = symbol.name.empty() ? std::filesystem::path(_file).filename().string() : symbol.name;
        overlay.layer = symbol.layer;
        overlay.symbol =
            GroundOverlay::Symbol{symbol.longitude, symbol.latitude, symbol.height, symbol.pixels};
        const osg::Vec2d degrees(symbol.longitude, symbol.latitude);
        if (isTooLarge(reach))
        {
            LocalOrigin nearest;
            double least = 1e30;
            for (const LocalOrigin& origin : CubeFace::origins())
            {
                const osg::Vec2d there(osg::RadiansToDegrees(origin.longitude),
                                       osg::RadiansToDegrees(origin.latitude));
                const double distance = arc(there, degrees);
                if (distance >= least) continue;
                least = distance;
                nearest = origin;
            }
            overlay.frame = frameAt(nearest, _file);
        }
        else
            overlay.frame = frameFor(reach, _file);
        const std::optional<osg::Vec2d> place = placeIn(overlay.frame, degrees);
        if (!place) return;
        const double half = symbol.side / 2.0;
        overlay.corners = {*place + osg::Vec2d(-half, -half), *place + osg::Vec2d(half, -half),
                           *place + osg::Vec2d(half, half), *place + osg::Vec2d(-half, half)};
        overlays.push_back(std::move(overlay));
    }

    /// Of degrees in a frame, metres.
    std::optional<osg::Vec2d> placeIn(std::size_t frame, const osg::Vec2d& degrees)
    {
        if (_placers.size() <= frame) _placers.resize(frame + 1);
        if (!_placers[frame]) _placers[frame] = OverlayRaster::placer(frameOf(frame), _file);
        return _placers[frame](degrees);
    }

    /// Null for a raster that is small enough. With tiles, a coarse picture is enough for the rest. `reach`: TiledRaster's.
    osg::ref_ptr<RasterTiles> tilesIn(const MappingFrame& frame, double reach, int& maxSide)
    {
        // A service's tiles are dear.
        const int coarse = reach > 0.0 ? 256 : 512;
        std::string error;
        osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(_raster, frame, _kind, error, _bands, reach);
        if (!tiles)
        {
            // What cannot be read at all says so below.
            notices.push_back(error);
            return nullptr;
        }
        const osg::Vec2d size = (tiles->high() - tiles->low()) / tiles->texel();
        if (std::max(size.x(), size.y()) <= maxSide) return nullptr;
        maxSide = std::min(maxSide, coarse);
        return tiles;
    }

    /// The parts of a raster from an index on have one range and one table.
    void giveColors(std::size_t first)
    {
        if (first == overlays.size() || overlays[first].layer->getKind() == DataLayer::COLOR) return;
        double lowest = overlays[first].lowest;
        double highest = overlays[first].highest;
        for (std::size_t i = first; i < overlays.size(); ++i)
        {
            lowest = std::min(lowest, overlays[i].lowest);
            highest = std::max(highest, overlays[i].highest);
        }
        osg::ref_ptr<ColorTable> table;
        std::string error;
        if (!_options.colors.empty())
        {
            table = _sld.table
                        ? _sld.table
                        : ColorRampFile::read(_options.colors, ColorRampFile::Range(lowest, highest), error);
            if (!table) throw BuildError(error);
        }
        for (std::size_t i = first; i < overlays.size(); ++i)
        {
            overlays[i].lowest = lowest;
            overlays[i].highest = highest;
            overlays[i].table = table;
        }
    }

    // Of a raster.
    SldColors _sld;
    std::optional<RasterBands> _bands;
    std::optional<DataLayer::Kind> _kind;

    double _texels = 0.0;
    std::set<const DataLayer*> _counted;                                               ///< in these
    std::vector<std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)>> _placers; ///< of frames
};

} // namespace

bool OverlayReader::read(const std::string& file, const Options& options, std::string& error)
{
    try
    {
        Work work(file, options, *this);
        work.read();
        frames = work.frames;
        std::move(work.overlays.begin(), work.overlays.end(), std::back_inserter(overlays));
        std::move(work.notices.begin(), work.notices.end(), std::back_inserter(notices));
        std::move(work.files.begin(), work.files.end(), std::back_inserter(files));
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
