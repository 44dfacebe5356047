// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/CameraPages.h>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/GpuLimits.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

constexpr std::int64_t texelsOfPage = std::int64_t{MappingPage::side} * MappingPage::side;
/// So much may be drawn anew in a frame where mappings have changed, pages' worth; more than that is drawn exactly.
constexpr std::int64_t pagesOfChanges = 4;
/// While fragments go through the mappings anyway, so many times the pages are drawn.
constexpr std::int64_t hurry = 4;
/// Pages that are coarser by so many levels may show in the place of those that a moving camera needs.
constexpr int coarserLevels = 4;

void setDefine(osg::StateSet& state, const std::string& name, bool on)
{
    state.setDefine(name, on ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
}

void setVector(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

void switchOff(osg::StateSet& state, const std::string& prefix)
{
    setDefine(state, prefix + "PAGES", false);
    setDefine(state, prefix + "PAGE_BASE", false);
}

/// Whether a base covers a rectangle, to the rounding.
bool covers(const PlaneFootprint& outline, const PlaneBox& box)
{
    const double sign = outline.signedArea() > 0.0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const osg::Vec2d& from = outline.corners[i];
        const osg::Vec2d along = outline.corners[(i + 1) % 4] - from;
        const double slack = 1e-6 * along.length2();
        for (const double x : {box.low.x(), box.high.x()})
        {
            for (const double y : {box.low.y(), box.high.y()})
            {
                const osg::Vec2d to = osg::Vec2d(x, y) - from;
                if (sign * (along.x() * to.y() - along.y() * to.x()) < -slack) return false;
            }
        }
    }
    return true;
}

} // namespace

void CameraPages::begin(Task task, osg::StateSet& state, const std::string& prefix)
{
    _task = std::move(task);
    _begun = true;
    switchOff(state, prefix);
}

void CameraPages::stop(osg::StateSet& state, const std::string& prefix)
{
    _task.reset();
    if (_begun) switchOff(state, prefix);
    _begun = false;
}

void CameraPages::say(const char* why)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _statistics.reason = why ? why : "";
    if (why) _statistics.settled = false;
    ++(why ? _statistics.exactFrames : _statistics.pagedFrames);
    if (!_residency) return;
    _statistics.pages = _residency->slots() - 1;
    _statistics.pagesUsed = _residency->used();
}

ProjectiveMappings::CacheStatistics CameraPages::statistics() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _statistics;
}

const char* CameraPages::obstacle(const ScenePass& pass, const std::vector<SeenGround>& seen,
                                  bool beyond) const
{
    if (_task->obstacle) return _task->obstacle;
    if (_task->frame.exact > 0) return "a mapping cannot be drawn beforehand";
    const auto* scene = dynamic_cast<const EffectScene*>(&pass.scene);
    if (scene && scene->getShaderHost()) return "an engine assembles the shaders";
    if (!pass.outer.getViewport()) return "the camera has no viewport";
    if (_watch.boundless()) return "the place of something that is drawn is not known";
    if (_task->frame.base &&
        (beyond || !std::all_of(seen.begin(), seen.end(),
                                [&](const SeenGround& ground)
                                { return covers(_task->frame.base->outline, ground.box); })))
        return "a mapping that changes the scene's colors does not cover all that is seen";
    return nullptr;
}

/// Tells the pages what has changed since the last frame.
void CameraPages::applyChanges(const ScenePass& pass)
{
    const int most = GpuLimits::of(pass.outer).textureSide;
    if (!_drawing || _drawing->megabytes() != _task->megabytes || _drawing->side() > most)
    {
        _drawing = std::make_unique<PageDrawing>(_task->megabytes, most);
        _residency = std::make_unique<PageResidency>(_drawing->slots());
        _showed = false;
    }
    const bool another = _gpu != _task->gpu.get();
    _gpu = _task->gpu.get();
    const std::optional<std::vector<PlaneBox>> boxes = _task->gpu->changedSince(_changes);
    // Another camera may have brought changes since, which this frame does not draw with: they come once more.
    _changes = _task->frame.changes;
    const bool sameLook = _opacity == _task->opacity && _anisotropy == _task->anisotropy;
    _opacity = _task->opacity;
    _anisotropy = _task->anisotropy;
    if (_lost.exchange(false) || !_drawing->holds(pass))
    {
        _drawing->forget();
        _residency->clear();
        _showed = false;
    }
    else if (another || !boxes || !sameLook)
        _residency->clear();
    else
    {
        for (const PlaneBox& box : *boxes)
            _residency->change(box);
    }
}

/// Whether there are pages to show.
bool CameraPages::plan(const ScenePass& pass, PageResidency::Frame& frame)
{
    std::optional<std::vector<MappingPage>> cut;
    const char* why = nullptr;
    osg::Vec2d blank;
    _task->gpu->withIndex(
        [&](const MappingIndex& index)
        {
            const MappingIndex::Root& root = index.root();
            PageView view(
                {root.origin, root.origin + osg::Vec2d(root.size, root.size)},
                [&index](const PlaneBox& box) { return index.empty(box.low, box.high); }, pass, _task->plane);
            const std::vector<SeenGround> seen = view.groundBelow(_watch.boxes());
            why = obstacle(pass, seen, view.beyond());
            if (!why) cut = _cut.make(seen, view, static_cast<std::size_t>(_residency->slots()));
            blank = root.origin - osg::Vec2d(root.size, root.size);
        });
    if (!why && !cut) why = "the picture needs more pages than there is memory for";
    if (why)
    {
        say(why);
        return false;
    }
    PageResidency::Budget budget;
    budget.changes = pagesOfChanges * texelsOfPage;
    budget.shown = _showed;
    budget.others = (_showed ? 1 : hurry) * _task->pagesPerFrame * texelsOfPage;
    frame = _residency->plan(*cut, budget);
    _drawing->draw(pass, frame.pieces, blank);
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _statistics.settled = frame.settled;
        _statistics.pagesDrawn += frame.pieces.size();
        for (const PageResidency::Piece& piece : frame.pieces)
        {
            const osg::Vec2d size = (piece.part.high - piece.part.low) / piece.page.texel();
            _statistics.texelsDrawn += static_cast<std::uint64_t>(size.x() * size.y());
        }
    }
    if (!frame.fits)
        why = "the picture needs more pages than there is memory for";
    else if (!frame.settled && !(_showed && frame.complete && frame.coarsest <= coarserLevels))
        why = "pages are being drawn";
    else if (!_table.write(frame.sources, _drawing->columns()))
        why = "near and far ground differ by too many levels";
    say(why);
    return !why;
}

void CameraPages::show(const ScenePass& pass, int pageUnit, int tableUnit)
{
    osg::StateSet& state = pass.state;
    const std::string& prefix = pass.prefix;
    setDefine(state, prefix + "PAGES", true);
    setDefine(state, prefix + "PAGE_BASE", _task->frame.base.has_value());
    state.setTextureAttribute(static_cast<unsigned int>(pageUnit), _drawing->texture());
    state.setTextureAttribute(static_cast<unsigned int>(tableUnit), _table.texture());
    state.getOrCreateUniform(prefix + "pages", osg::Uniform::INT)->set(pageUnit);
    state.getOrCreateUniform(prefix + "pageTable", osg::Uniform::INT)->set(tableUnit);
    const auto setThree = [&](const char* name, double x, double y, double z)
    {
        state.getOrCreateUniform(prefix + name, osg::Uniform::FLOAT_VEC3)
            ->set(osg::Vec3(osg::Vec3d(x, y, z)));
    };
    const double inverseCell = _table.inverseCell(), share = 1.0 / _table.cells();
    setThree("pageFrame", -_table.anchor().x() * inverseCell, -_table.anchor().y() * inverseCell,
             inverseCell);
    const auto [column, row] = _table.corner();
    setThree("pageWindow", (0.5 - column) * share, (0.5 - row) * share, share);
    const double slotX = 1.0 / _drawing->columns(), slotY = 1.0 / _drawing->rows();
    constexpr double inner = 1.0 * MappingPage::inner / MappingPage::side;
    constexpr double border = 1.0 * MappingPage::border / MappingPage::side;
    setVector(state, prefix + "pageShape", {slotX, slotY, inner * slotX, inner * slotY});
    state.getOrCreateUniform(prefix + "pageStart", osg::Uniform::FLOAT_VEC2)
        ->set(osg::Vec2(osg::Vec2d(border * slotX, border * slotY)));
    if (const std::optional<PageBase>& base = _task->frame.base)
    {
        const char* const rows[] = {"baseRed", "baseGreen", "baseBlue"};
        for (std::size_t i = 0; i < 3; ++i)
            setVector(state, prefix + rows[i], base->matrix[i]);
        state.getOrCreateUniform(prefix + "baseStrength", osg::Uniform::FLOAT)
            ->set(static_cast<float>(base->strength * _task->opacity));
    }
}

void CameraPages::draw(const ScenePass& pass, int pageUnit, int tableUnit)
{
    if (!_task) return;
    applyChanges(pass);
    PageResidency::Frame frame;
    _showed = plan(pass, frame);
    if (_showed) show(pass, pageUnit, tableUnit);
    _task.reset();
}

void CameraPages::releaseGLObjects(osg::State* state)
{
    _lost = true;
    if (_drawing) _drawing->releaseGLObjects(state);
    _table.releaseGLObjects(state);
}

void CameraPages::resizeGLObjectBuffers(unsigned int size)
{
    if (_drawing) _drawing->resizeGLObjectBuffers(size);
    _table.resizeGLObjectBuffers(size);
}

} // namespace osgGeoFX
