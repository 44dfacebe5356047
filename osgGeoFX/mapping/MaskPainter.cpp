// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/MaskPainter.h>

#include <osgGeoFX/mapping/PointerPlace.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <glm/glm.hpp>
#include <osg/Notify>
#include <osgViewer/View>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

osg::Vec2d divided(const glm::dvec3& p)
{
    return {p.x / p.z, p.y / p.z};
}

double distanceToLine(const osg::Vec2d& place, const osg::Vec2d& from, const osg::Vec2d& to)
{
    const osg::Vec2d along = to - from;
    const double length2 = along.length2();
    const double share = length2 > 0.0 ? std::clamp((place - from) * along / length2, 0.0, 1.0) : 0.0;
    return (place - from - along * share).length();
}

osg::ref_ptr<osg::Image> emptyMask(int width, int height)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(std::clamp(width, 1, 16384), std::clamp(height, 1, 16384), 1, GL_LUMINANCE,
                         GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), static_cast<unsigned char>(0));
    return image;
}

} // namespace

MaskPainter::MaskPainter(ProjectiveMapping& mapping, int width, int height) : _mapping(&mapping)
{
    osg::ref_ptr<DataLayer> layer = new DataLayer(emptyMask(width, height));
    // Greys are shares here and not light.
    layer->setSRgb(false);
    _mapping->setMask(layer);
    _mapping->getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
    _image = layer->getImage();
}

MaskPainter::~MaskPainter() = default;

bool MaskPainter::setBrush(const Brush& brush)
{
    if (!within(brush.radius, 1e-3, 1e7) || !within(brush.hardness, 0.0, 1.0) ||
        !within(brush.strength, 0.0, 1.0))
    {
        OSG_WARN << "osgGeoFX: MaskPainter got a brush out of range; the former one stays." << std::endl;
        return false;
    }
    _brush = brush;
    return true;
}

MaskPainter::Area MaskPainter::whole() const
{
    return {0, 0, _image->s(), _image->t()};
}

MaskPainter::Area MaskPainter::areaAround(const osg::Vec2d& from, const osg::Vec2d& to) const
{
    const glm::dmat3 toRaster = _mapping->placeToRaster();
    osg::Vec2d low(1e30, 1e30);
    osg::Vec2d high(-1e30, -1e30);
    for (const osg::Vec2d& end : {from, to})
    {
        for (int corner = 0; corner < 4; ++corner)
        {
            const osg::Vec2d place =
                end + osg::Vec2d(corner % 2 ? 1.0 : -1.0, corner / 2 ? 1.0 : -1.0) * _brush.radius;
            const glm::dvec3 found = toRaster * glm::dvec3(place.x(), place.y(), 1.0);
            // Beyond the horizon of a projective transform boxes tell nothing.
            if (!(found.z > 0.0)) return whole();
            const osg::Vec2d raster = divided(found);
            low.set(std::min(low.x(), raster.x()), std::min(low.y(), raster.y()));
            high.set(std::max(high.x(), raster.x()), std::max(high.y(), raster.y()));
        }
    }
    const auto texel = [](double share, int count)
    {
        return static_cast<int>(std::floor(std::clamp(share, 0.0, 1.0) * count));
    };
    return {texel(low.x(), _image->s()), texel(low.y(), _image->t()),
            std::min(texel(high.x(), _image->s()) + 1, _image->s()),
            std::min(texel(high.y(), _image->t()) + 1, _image->t())};
}

void MaskPainter::begin(const osg::Vec2d& place)
{
    end();
    _before.assign(_image->data(), _image->data() + static_cast<std::size_t>(_image->s()) * _image->t());
    _cover.assign(_before.size(), 0.0f);
    _touched = {};
    _last = place;
    draw(place, place);
}

void MaskPainter::moveTo(const osg::Vec2d& place)
{
    if (!_last) return begin(place);
    draw(*_last, place);
    _last = place;
}

void MaskPainter::end()
{
    if (!_last) return;
    _last.reset();
    if (_touched.empty()) return;
    Stroke stroke{_touched, {}};
    for (int row = _touched.bottom; row < _touched.top; ++row)
    {
        const auto start = _before.begin() + static_cast<std::ptrdiff_t>(row) * _image->s();
        stroke.before.insert(stroke.before.end(), start + _touched.left, start + _touched.right);
    }
    keep(std::move(stroke));
}

void MaskPainter::draw(const osg::Vec2d& from, const osg::Vec2d& to)
{
    const Area area = areaAround(from, to);
    if (area.empty()) return;
    const glm::dmat3 toPlace = glm::inverse(_mapping->placeToRaster());
    const double soft = std::max(_brush.radius * (1.0 - _brush.hardness), 1e-6);
    const double target = _brush.erase ? 0.0 : 255.0;
    for (int row = area.bottom; row < area.top; ++row)
    {
        for (int column = area.left; column < area.right; ++column)
        {
            const osg::Vec2d place =
                divided(toPlace * glm::dvec3((column + 0.5) / _image->s(), (row + 0.5) / _image->t(), 1.0));
            const double share =
                std::clamp((_brush.radius - distanceToLine(place, from, to)) / soft, 0.0, 1.0);
            const double cover = share * share * (3.0 - 2.0 * share) * _brush.strength;
            const std::size_t texel = static_cast<std::size_t>(row) * _image->s() + column;
            if (cover <= static_cast<double>(_cover[texel])) continue;
            _cover[texel] = static_cast<float>(cover);
            const double before = _before[texel];
            *_image->data(column, row) =
                static_cast<unsigned char>(std::lround(before + (target - before) * cover));
        }
    }
    _touched = _touched.empty()
                   ? area
                   : Area{std::min(_touched.left, area.left), std::min(_touched.bottom, area.bottom),
                          std::max(_touched.right, area.right), std::max(_touched.top, area.top)};
    _image->dirty();
}

void MaskPainter::keep(Stroke stroke)
{
    _strokes.push_back(std::move(stroke));
    setHistory(_history);
}

void MaskPainter::setHistory(std::size_t strokes)
{
    _history = strokes;
    if (_strokes.size() > _history)
        _strokes.erase(_strokes.begin(), _strokes.end() - static_cast<std::ptrdiff_t>(_history));
}

bool MaskPainter::undo()
{
    end();
    if (_strokes.empty()) return false;
    const Stroke stroke = std::move(_strokes.back());
    _strokes.pop_back();
    const std::ptrdiff_t width = stroke.area.right - stroke.area.left;
    auto from = stroke.before.begin();
    for (int row = stroke.area.bottom; row < stroke.area.top; ++row, from += width)
        std::copy(from, from + width, _image->data(stroke.area.left, row));
    _image->dirty();
    return true;
}

void MaskPainter::fill(double grey)
{
    end();
    unsigned char* data = _image->data();
    unsigned char* const last = data + static_cast<std::size_t>(_image->s()) * _image->t();
    keep({whole(), {data, last}});
    std::fill(data, last, static_cast<unsigned char>(std::lround(std::clamp(grey, 0.0, 1.0) * 255.0)));
    _image->dirty();
}

double MaskPainter::at(const osg::Vec2d& place) const
{
    const osg::Vec2d raster = divided(_mapping->placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0));
    if (!within(raster.x(), 0.0, 1.0) || !within(raster.y(), 0.0, 1.0)) return 0.0;
    const int column = std::min(static_cast<int>(raster.x() * _image->s()), _image->s() - 1);
    const int row = std::min(static_cast<int>(raster.y() * _image->t()), _image->t() - 1);
    return *_image->data(column, row) / 255.0;
}

MaskPaintHandler::MaskPaintHandler(EffectScene& scene, ProjectiveMappings& mappings, MaskPainter& painter)
    : _scene(&scene), _mappings(&mappings), _painter(&painter)
{
}

MaskPaintHandler::~MaskPaintHandler() = default;

void MaskPaintHandler::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Shift + left button", "Paint the mask; with Ctrl as well, erase it");
    usage.addKeyboardMouseBinding("Shift + wheel", "Make the brush larger or smaller");
    usage.addKeyboardMouseBinding("Ctrl + Z", "Take the last stroke back");
}

bool MaskPaintHandler::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    using Event = osgGA::GUIEventAdapter;
    const Event::EventType type = event.getEventType();
    const bool shift = (event.getModKeyMask() & Event::MODKEY_SHIFT) != 0;
    const bool control = (event.getModKeyMask() & Event::MODKEY_CTRL) != 0;
    if (type == Event::KEYDOWN && control && event.getUnmodifiedKey() == 'z')
    {
        if (_painter->undo()) action.requestRedraw();
        return true;
    }
    if (type == Event::SCROLL && shift)
    {
        const Event::ScrollingMotion motion = event.getScrollingMotion();
        if (motion != Event::SCROLL_UP && motion != Event::SCROLL_DOWN) return false;
        MaskPainter::Brush brush = _painter->getBrush();
        brush.radius = std::clamp(brush.radius * (motion == Event::SCROLL_UP ? 1.2 : 1.0 / 1.2), 0.1, 1e6);
        return _painter->setBrush(brush);
    }
    if (type == Event::RELEASE && _painter->painting())
    {
        _painter->end();
        return true;
    }
    const bool starts = type == Event::PUSH && event.getButton() == Event::LEFT_MOUSE_BUTTON && shift;
    const bool goesOn = type == Event::DRAG && _painter->painting();
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view || (!starts && !goesOn)) return false;
    if (starts)
    {
        MaskPainter::Brush brush = _painter->getBrush();
        brush.erase = control;
        _painter->setBrush(brush);
    }
    const std::optional<osg::Vec3d> place = placeUnderPointer(*_scene, *_mappings, *view->getCamera(), event);
    if (!place) return true;
    if (starts)
        _painter->begin({place->x(), place->y()});
    else
        _painter->moveTo({place->x(), place->y()});
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
