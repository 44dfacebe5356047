// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/TiledVectors.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/CubeFace.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/geodata/detail/ShapePainter.h>
#include <osgGeoFX/geodata/detail/VectorShapes.h>

#include <cpl_conv.h>
#include <cpl_quad_tree.h>
#include <osg/BoundingBox>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr double earthRadius = 6371e3; // metres
/// Of frames whose places are floats.
constexpr double places = 4194304.0;
constexpr double finest = 0.02; // metres

struct TreeFreer
{
    void operator()(CPLQuadTree* tree) const { CPLQuadTreeDestroy(tree); }
};

double texelOf(double radius)
{
    return std::max(finest, 2.0 * std::min(radius, CubeFace::leastRadius) * earthRadius / places);
}

/// What of the Earth a face of the cube shows, with some margin.
DegreeBox faceBoxOf(const LocalOrigin& origin)
{
    const double latitude = osg::RadiansToDegrees(origin.latitude);
    if (latitude > 1.0) return {-180.0, 30.0, 180.0, 90.0};
    if (latitude < -1.0) return {-180.0, -90.0, 180.0, -30.0};
    const double longitude = osg::RadiansToDegrees(origin.longitude);
    return {longitude - 50.0, -50.0, longitude + 50.0, 50.0};
}

class Tiles final : public RasterTiles
{
public:
    Tiles(std::shared_ptr<const VectorShapes> shapes, const MappingFrame& frame,
          const std::optional<MappingRaster::Window>& window, TiledVectors::Options options)
        : _shapes(std::move(shapes)), _frame(frame), _window(window), _options(std::move(options))
    {
        std::optional<DegreeBox> box;
        if (window)
            box = faceBoxOf(frame.origin);
        else if (!frame.globe)
            box = VectorShapes::reachOf(frame);
        _placed = _shapes->placedIn(frame, box);
        for (const VectorShape& shape : _placed)
            _boxes.push_back(boxOf(shape));
        osg::BoundingBoxd all;
        for (const VectorShapes::Item& item : _shapes->items)
            all.expandBy(_boxes[item.shape]);
        if (window)
        {
            _low = window->low;
            _high = window->high;
            _texel = std::max(finest, (_high.x() - _low.x()) / places);
        }
        if (!all.valid()) return;
        index(all);
        if (window) return;
        _texel = std::max(finest, 2.0 * all.radius() / places);
        // Lines are wide, and a single point has no size.
        const double margin = std::max({64.0 * _texel, 0.02 * all.radius(), reachOf(_texel)});
        _low = osg::Vec2d(all.xMin() - margin, all.yMin() - margin);
        _high = osg::Vec2d(all.xMax() + margin, all.yMax() + margin);
    }

    bool empty() const { return _high.x() <= _low.x(); }
    osg::Vec2d low() const override { return _low; }
    osg::Vec2d high() const override { return _high; }
    double texel() const override { return _texel; }
    DataLayer::Kind kind() const override { return DataLayer::COLOR; }
    std::optional<LayerSource> source() const override
    {
        LayerSource source = sourceOf(_shapes->file, _frame);
        source.vectors = LayerSource::Vectors{_options.layer, _options.style, _options.allowOutside};
        return source;
    }

    bool hasLengthsInPixels() const override { return true; }
    osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                  std::string& error) override
    {
        return readCoarser(from, to, columns, rows, 1.0, error);
    }
    osg::ref_ptr<osg::Image> readCoarser(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                         double coarseness, std::string& error) override
    {
        try
        {
            ShapePainter painter(from, to, columns, rows, coarseness);
            const double texel = (to.x() - from.x()) / columns;
            for (const std::uint32_t i : itemsWithin(from, to, reachOf(texel)))
                painter.draw(_placed[_shapes->items[i].shape], _shapes->paints[_shapes->items[i].paint]);
            osg::ref_ptr<osg::Image> image = painter.finish();
            if (_window)
                CubeFace::cut(*image, MappingRaster::Window{from, to, texel},
                              std::abs(_frame.origin.latitude) > 1.0);
            image->setFileName(_shapes->file);
            return image;
        }
        catch (const BuildError& failure)
        {
            error = failure.what();
            return nullptr;
        }
    }

protected:
    ~Tiles() override = default;

private:
    static osg::BoundingBoxd boxOf(const VectorShape& shape)
    {
        osg::BoundingBoxd box;
        for (const std::vector<osg::Vec2d>& part : shape.parts)
            for (const osg::Vec2d& place : part)
                box.expandBy(osg::Vec3d(place, 0.0));
        return box;
    }

    double reachOf(double texel) const
    {
        double reach = 0.0;
        for (const ShapePaint& paint : _shapes->paints)
            reach = std::max(reach, ShapePainter::reachOf(paint, texel));
        return reach;
    }

    void index(const osg::BoundingBoxd& all)
    {
        const CPLRectObj bounds{all.xMin(), all.yMin(), all.xMax(), all.yMax()};
        _tree.reset(CPLQuadTreeCreate(&bounds, nullptr));
        for (std::size_t i = 0; i < _shapes->items.size(); ++i)
        {
            const osg::BoundingBoxd& box = _boxes[_shapes->items[i].shape];
            if (!box.valid()) continue;
            const CPLRectObj here{box.xMin(), box.yMin(), box.xMax(), box.yMax()};
            CPLQuadTreeInsertWithBounds(_tree.get(), reinterpret_cast<void*>(i + 1), &here);
        }
    }

    /// In their order.
    std::vector<std::uint32_t> itemsWithin(const osg::Vec2d& low, const osg::Vec2d& high, double reach) const
    {
        if (!_tree) return {};
        const CPLRectObj box{low.x() - reach, low.y() - reach, high.x() + reach, high.y() + reach};
        int count = 0;
        void** const found = CPLQuadTreeSearch(_tree.get(), &box, &count);
        std::vector<std::uint32_t> items;
        for (int i = 0; i < count; ++i)
            items.push_back(static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(found[i]) - 1));
        CPLFree(found);
        std::sort(items.begin(), items.end());
        return items;
    }

    const std::shared_ptr<const VectorShapes> _shapes;
    const MappingFrame _frame;
    const std::optional<MappingRaster::Window> _window;
    const TiledVectors::Options _options;
    std::vector<VectorShape> _placed;
    std::vector<osg::BoundingBoxd> _boxes; ///< of these
    std::unique_ptr<CPLQuadTree, TreeFreer> _tree;
    osg::Vec2d _low, _high;
    double _texel = finest;
};

/// The pictures of the symbols, and how large they may be on the ground.
std::vector<TiledVectors::Symbol> symbolsOf(const VectorShapes& shapes, bool anyFormat)
{
    struct Picture
    {
        osg::ref_ptr<DataLayer> layer;
        double side = 0.0;
    };
    std::vector<Picture> pictures;
    for (const SymbolPaint& paint : shapes.symbolPaints)
    {
        Picture picture;
        const osg::ref_ptr<osg::Image> image =
            ShapePainter::symbol(paint, shapes.file, anyFormat, picture.side);
        picture.layer = new DataLayer(image);
        pictures.push_back(picture);
    }
    // From far away, symbols in pixels would cover each other, and each fragment would ask all of them: so they get smaller there.
    const double area = osg::PI * std::pow(std::max(shapes.radius, 1e-7) * earthRadius, 2.0);
    const auto count = static_cast<double>(shapes.symbols.size());
    const double room = std::sqrt(16.0 * area / std::max(count, 1.0));
    std::vector<TiledVectors::Symbol> symbols;
    for (const VectorShapes::Symbol& each : shapes.symbols)
    {
        const Picture& picture = pictures[each.paint];
        TiledVectors::Symbol symbol;
        symbol.name = each.name;
        symbol.longitude = each.place.x();
        symbol.latitude = each.place.y();
        symbol.height = each.height;
        symbol.layer = picture.layer;
        symbol.side = picture.side;
        if (!shapes.symbolPaints[each.paint].metres)
        {
            constexpr double metresOfPixel = 4.0, mostMetresOfPixel = 100.0;
            constexpr double few = 100.0;
            symbol.pixels = picture.side;
            symbol.side = picture.side * mostMetresOfPixel;
            if (count > few) symbol.side = std::clamp(room, picture.side * metresOfPixel, symbol.side);
        }
        symbols.push_back(std::move(symbol));
    }
    return symbols;
}

} // namespace

std::optional<TiledVectors> TiledVectors::read(const std::string& file, const Options& options,
                                               std::string& error)
{
    try
    {
        TiledVectors result;
        result._shapes = std::make_shared<VectorShapes>(
            VectorShapes::read(file, {options.layer, options.style, options.allowOutside}));
        result._symbols = symbolsOf(*result._shapes, options.allowOutside);
        result._options = options;
        return result;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

bool TiledVectors::isVectors(const std::string& file)
{
    return VectorShapes::isVectors(file);
}

bool TiledVectors::hasShapes() const
{
    return !_shapes->items.empty();
}

osg::Vec2d TiledVectors::middle() const
{
    return _shapes->middle;
}

double TiledVectors::radius() const
{
    return _shapes->radius;
}

double TiledVectors::texel() const
{
    return texelOf(_shapes->radius);
}

const std::vector<std::string>& TiledVectors::notices() const
{
    return _shapes->notices;
}

osg::ref_ptr<RasterTiles> TiledVectors::tiles(const MappingFrame& frame,
                                              const std::optional<MappingRaster::Window>& window,
                                              std::string& error) const
{
    try
    {
        osg::ref_ptr<Tiles> tiles = new Tiles(_shapes, frame, window, _options);
        if (!tiles->empty()) return tiles;
        error = _shapes->file +
                ": none of its areas and lines lies where the terrain's projection has a place; "
                "show it on a globe, or on a terrain nearby.";
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
    }
    return nullptr;
}

osg::ref_ptr<RasterTiles> TiledVectors::open(const LayerSource& source, std::string& error)
{
    const LayerSource::Vectors how = source.vectors.value_or(LayerSource::Vectors());
    const std::optional<TiledVectors> vectors =
        read(source.file, {how.layer, how.style, how.allowOutside}, error);
    if (!vectors) return nullptr;
    MappingFrame frame;
    frame.globe = source.globe;
    frame.wkt = source.wkt;
    frame.origin = source.origin;
    std::optional<MappingRaster::Window> window;
    if (source.globe && vectors->radius() > CubeFace::leastRadius)
        window = CubeFace::window(vectors->texel());
    return vectors->tiles(frame, window, error);
}

} // namespace osgGeoFX
