// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/DeformedIntersector.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/scene/detail/DividedTriangles.h>
#include <osgGeoFX/scene/detail/PatchTwins.h>
#include <osgGeoFX/scene/detail/UndeformedParts.h>

#include <osg/PagedLOD>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace osgGeoFX
{

namespace
{

/// Corners of triangles that are judged together, before any of them is deformed. Neighbours in a mesh are mostly neighbours in
/// the list.
constexpr std::size_t RUN = 3 * 64;

/// From a continent down to metres, for both directions of a triangle.
constexpr int mostHalvings = 44;

/// Where a ray meets a triangle: the distance in units of the direction, negative where it misses, and the shares of the
/// second and third corner.
struct Meeting
{
    double distance = -1.0, u = 0.0, v = 0.0;
};

/// Möller and Trumbore, from both sides.
Meeting meet(const osg::Vec3d& origin, const osg::Vec3d& direction, const osg::Vec3d& a, const osg::Vec3d& b,
             const osg::Vec3d& c)
{
    const osg::Vec3d ab = b - a;
    const osg::Vec3d ac = c - a;
    const osg::Vec3d p = direction ^ ac;
    const double determinant = ab * p;
    // Where a deformation gathers ground in one point of the picture, triangles are lines of sight, and nothing but rounding.
    if (std::abs(determinant) <= 1e-10 * ab.length() * p.length()) return {};
    const osg::Vec3d from = origin - a;
    const double u = (from * p) / determinant;
    const osg::Vec3d q = from ^ ab;
    const double v = (direction * q) / determinant;
    // Neighbours share their edges: a ray between them must not slip through.
    constexpr double tolerance = 1e-9;
    if (u < -tolerance || v < -tolerance || u + v > 1.0 + tolerance) return {};
    return {(ac * q) / determinant, u, v};
}

/// Where a ray meets the parts of a triangle that the GPU divides, each deformed by itself; the shares are those of the whole triangle.
std::vector<Meeting> meetParts(const osg::Vec3d& origin, const osg::Vec3d& direction,
                               const DeformationChain& chain, int parts,
                               const std::array<osg::Vec3d, 3>& corners)
{
    const auto row = [&](int j)
    {
        std::vector<osg::Vec3d> places;
        for (int i = 0; i + j <= parts; ++i)
            places.push_back(chain.deform(corners[0] + (corners[1] - corners[0]) * (1.0 * i / parts) +
                                          (corners[2] - corners[0]) * (1.0 * j / parts)));
        return places;
    };
    std::vector<Meeting> all;
    const auto add = [&](Meeting met, double u, double v)
    {
        met.u = u / parts;
        met.v = v / parts;
        if (met.distance >= 0.0) all.push_back(met);
    };
    std::vector<osg::Vec3d> lower = row(0);
    for (int j = 0; j < parts; ++j)
    {
        const std::vector<osg::Vec3d> upper = row(j + 1);
        for (std::size_t i = 0; i + 1 < lower.size(); ++i)
        {
            const auto at = static_cast<double>(i);
            const Meeting one = meet(origin, direction, lower[i], lower[i + 1], upper[i]);
            add(one, at + one.u, j + one.v);
            if (i + 1 == upper.size()) continue;
            const Meeting other = meet(origin, direction, lower[i + 1], upper[i + 1], upper[i]);
            add(other, at + 1.0 - other.v, j + other.u + other.v);
        }
        lower = upper;
    }
    return all;
}

Ball ballAround(const std::array<osg::Vec3d, 3>& corners)
{
    Ball ball = {(corners[0] + corners[1] + corners[2]) / 3.0, 0.0};
    for (const osg::Vec3d& each : corners)
        ball.radius = std::max(ball.radius, (each - ball.center).length());
    return ball;
}

/// A triangle in eye space, flat and as it is drawn.
struct Piece
{
    std::array<osg::Vec3d, 3> flat, drawn;
};

/// Divides a triangle until its pieces follow the deformation, and calls an action with each. `meets`: whether a ball where things are drawn
/// matters.
template<typename Meets, typename Action>
void followCurve(const Piece& piece, int halvings, const DeformationChain& chain, const Meets& meets,
                 const Action& action)
{
    if (!meets(chain.bound(ballAround(piece.flat)))) return;
    // Each edge is judged by itself: so a neighbour has it divided at the same places, and no ray slips through.
    constexpr double sag = 1e-3, shortest = 4e-3;
    std::size_t longest = 3;
    double most = 0.0, off = 0.0;
    std::array<osg::Vec3d, 3> flat, drawn;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t k = (i + 1) % 3;
        flat[i] = (piece.flat[i] + piece.flat[k]) * 0.5;
        drawn[i] = chain.deform(flat[i]);
        const double length = (piece.flat[i] - piece.flat[k]).length();
        const double distance = std::max(drawn[i].length(), 1.0);
        const double here = (drawn[i] - (piece.drawn[i] + piece.drawn[k]) * 0.5).length();
        off = std::max(off, here);
        if (!(here > sag * distance && length > std::max(shortest * distance, most))) continue;
        longest = i;
        most = length;
    }
    if (longest == 3 || halvings == 0)
    {
        action(piece);
        return;
    }
    // Bounds of a deformation are wide. What lies between the corners bulges about as far as the edges do.
    Ball ball = ballAround(piece.drawn);
    ball.radius += off;
    if (!meets(ball)) return;
    for (const std::size_t end : {longest, (longest + 1) % 3})
    {
        Piece part = piece;
        part.flat[end] = flat[longest];
        part.drawn[end] = drawn[longest];
        followCurve(part, halvings - 1, chain, meets, action);
    }
}

/// The engine of the scene at or above a node; null for none.
const ShaderHost* hostOf(const osg::Node& node)
{
    if (const auto* const scene = dynamic_cast<const EffectScene*>(&node)) return scene->getShaderHost();
    for (const osg::Group* const parent : node.getParents())
    {
        if (const ShaderHost* const host = hostOf(*parent)) return host;
    }
    return nullptr;
}

} // namespace

DeformedLineIntersector::DeformedLineIntersector(const osg::Vec3d& origin, const osg::Vec3d& direction)
    : osgUtil::Intersector(osgUtil::Intersector::MODEL), _origin(origin), _direction(direction),
      _chain(new DeformationChain)
{
    _direction.normalize();
}

DeformedLineIntersector::~DeformedLineIntersector() = default;

const std::vector<DeformedLineIntersector::Intersection>& DeformedLineIntersector::intersections() const
{
    auto* self = const_cast<DeformedLineIntersector*>(this)->root();
    if (!self->_sorted) std::sort(self->_found.begin(), self->_found.end());
    self->_sorted = true;
    return self->_found;
}

void DeformedLineIntersector::reset()
{
    osgUtil::Intersector::reset();
    _found.clear();
    _sorted = true;
}

osgUtil::Intersector* DeformedLineIntersector::clone(osgUtil::IntersectionVisitor& visitor)
{
    auto* result = new DeformedLineIntersector(_origin, _direction);
    result->_root = root();
    result->_curved = _curved;
    if (auto* ours = dynamic_cast<DeformedIntersectionVisitor*>(&visitor))
    {
        result->_chain = &ours->chain();
        result->_programs = ours->_programs.get();
        result->_modelView = ours->modelView();
        result->_scale = largestScale(result->_modelView);
    }
    return result;
}

bool DeformedLineIntersector::meets(const Ball& ball) const
{
    const osg::Vec3d toCenter = ball.center - _origin;
    const double along = toCenter * _direction;
    const double radius = ball.radius * (1.0 + 1e-9) + 1e-6;
    if (along < 0.0) return toCenter.length2() <= radius * radius;
    return (toCenter - _direction * along).length2() <= radius * radius;
}

bool DeformedLineIntersector::misses(const EyeBox& box, double reach) const
{
    Hull hull;
    _chain->bound(box, hull);
    hull.margin += reach;
    // Along the ray the hull is a flat figure, and the ray a point: has it a side with nothing of the figure?
    osg::Vec3d across = _direction ^ osg::Vec3d(0.0, 1.0, 0.0);
    if (across.length2() < 0.01) across = _direction ^ osg::Vec3d(1.0, 0.0, 0.0);
    across.normalize();
    const osg::Vec3d up = across ^ _direction;
    constexpr int sides = 16;
    for (int side = 0; side < sides; ++side)
    {
        const double angle = 2.0 * osg::PI * side / sides;
        const osg::Vec3d outward = across * std::cos(angle) + up * std::sin(angle);
        const double margin = hull.margin + 1e-6;
        if (std::all_of(hull.points.begin(), hull.points.end(),
                        [&](const osg::Vec3d& point)
                        { return (point - _origin) * outward > margin + 1e-9 * point.length(); }))
            return true;
    }
    return false;
}

bool DeformedLineIntersector::enter(const osg::Node& node)
{
    if (!node.isCullingActive()) return true;
    const osg::BoundingSphere& sphere = node.getBound();
    if (!sphere.valid()) return false;
    const Ball undeformed = {osg::Vec3d(sphere.center()) * _modelView,
                             static_cast<double>(sphere.radius()) * _scale};
    if (meets(_chain->bound(undeformed))) return true;
    // What stays where it is while the rest is deformed, as in culling.
    return _programs && !_chain->empty() && meets(undeformed) && UndeformedParts::search(node, *_programs);
}

void DeformedLineIntersector::intersect(osgUtil::IntersectionVisitor& visitor, osg::Drawable* drawable)
{
    if (root()->reachedLimit()) return;
    const osg::BoundingBox& bounds = drawable->getBoundingBox();
    if (!bounds.valid()) return;
    const EyeBox whole = EyeBox::of(bounds, _modelView);
    if (!meets(_chain->bound(whole.ball()))) return;
    // Many things in one drawable, each of which keeps its shape.
    const osg::Vec4Array* references = RigidParts::inForce(visitor.getNodePath());
    const double reach = references ? RigidParts::reach(*drawable, *_chain, whole.ball(), _scale) : 0.0;
    if (misses(whole, reach)) return;
    const DrawableTriangles mesh(*drawable);
    // Where the vertices of a run are drawn. The ray comes near few runs of many.
    std::unordered_map<unsigned int, osg::Vec3d> deformed;
    if (references && references->size() != mesh.positions().size()) references = nullptr;
    const auto reference = [&](std::size_t vertex)
    {
        const osg::Vec4& each = (*references)[vertex];
        return osg::Vec3d(osg::Vec3(each.x(), each.y(), each.z())) * _modelView;
    };
    const auto deform = [&](unsigned int vertex)
    {
        const auto [place, isNew] = deformed.try_emplace(vertex);
        if (!isNew) return;
        const osg::Vec3d eye = mesh.positions()[vertex] * _modelView;
        place->second = references ? RigidParts::place(*_chain, eye, reference(vertex)) : _chain->deform(eye);
    };
    const auto missesRun = [&](std::size_t begin, std::size_t end)
    {
        osg::BoundingBoxd box;
        for (std::size_t i = begin; i < end; ++i)
            box.expandBy(mesh.positions()[mesh.corners()[i]]);
        if (!meets(_chain->bound(Ball{box.center() * _modelView, box.radius() * _scale}))) return true;
        // Boxes of eye space come from single precision.
        const double rounding = 1e-7 * (box.center().length() + box.radius()) * _scale;
        return misses(EyeBox::of(osg::BoundingBox(box._min, box._max), _modelView), rounding);
    };

    const auto* ours = dynamic_cast<const DeformedIntersectionVisitor*>(&visitor);
    const bool divides = ours && !OwnPrograms::isOwn(ours->_deformation.program) &&
                         PatchTwins::mayHave(*drawable) && DividedTriangles::within(*_chain, whole);
    const auto flatOf = [&](std::size_t i)
    {
        std::array<osg::Vec3d, 3> flat;
        for (std::size_t k = 0; k < 3; ++k)
            flat[k] = mesh.positions()[mesh.corners()[i + k]] * _modelView;
        return flat;
    };
    const bool curved = _curved && !references && DividedTriangles::curves(*_chain, whole);
    const auto meetsBall = [&](const Ball& ball)
    {
        return meets(ball);
    };
    // A meeting with the triangle from corner i on, or with a piece of it.
    const auto note = [&](std::size_t i, const std::array<osg::Vec3d, 3>& piece, const Meeting& met)
    {
        const unsigned int* corner = &mesh.corners()[i];
        // Nothing is seen at the eye itself, where a cylindrical map gathers what lies opposite of its picture.
        const double size = deformed[corner[0]].length() + deformed[corner[1]].length();
        if (!(met.distance >= 0.0) || (_origin == osg::Vec3d() && met.distance <= 1e-9 * size)) return;
        Intersection hit;
        hit.distance = met.distance;
        hit.deformed = _origin + _direction * met.distance;
        hit.drawable = drawable;
        hit.triangle = static_cast<unsigned int>(i / 3);
        hit.path = visitor.getNodePath();
        const osg::RefMatrix* toWorld = visitor.getModelMatrix();
        const osg::Matrixd model = toWorld ? osg::Matrixd(*toWorld) : osg::Matrixd();
        osg::Matrixd toLocal;
        toLocal.invert(_modelView);
        const osg::Vec3d* first = mesh.positions().data();
        const osg::Vec3d a = piece[0], ab = piece[1] - a, ac = piece[2] - a;
        const osg::Vec3d flat = a + ab * met.u + ac * met.v;
        osg::Vec3d eye = references ? flat : _chain->undeform(hit.deformed);
        // Where a deformation gathers ground in one point, the flat triangle that is drawn may lie where no ground goes.
        if (!((eye - flat).length2() <= std::max(ab.length2(), ac.length2()))) eye = flat;
        hit.world = eye * toLocal * model;
        hit.normal = (first[corner[1]] - first[corner[0]]) ^ (first[corner[2]] - first[corner[0]]);
        hit.normal = osg::Matrixd::transform3x3(hit.normal, model);
        hit.normal.normalize();
        root()->_found.push_back(hit);
        root()->_sorted = false;
    };
    const std::size_t count = mesh.corners().size();
    for (std::size_t begin = 0; begin < count; begin += RUN)
    {
        const std::size_t end = std::min(begin + RUN, count);
        // Rigid parts may leave the bounds of ground at their place.
        if (!references && count > RUN && missesRun(begin, end)) continue;
        deformed.clear();
        for (std::size_t i = begin; i < end; i += 3)
        {
            const unsigned int* corner = &mesh.corners()[i];
            int parts = 1;
            if (divides && !curved)
            {
                const std::array<osg::Vec3d, 3> flat = flatOf(i);
                if (!meets(_chain->bound(ballAround(flat)))) continue;
                for (std::size_t k = 0; k < 3; ++k)
                    parts = std::max(parts, DividedTriangles::parts(*_chain, flat[k], flat[(k + 1) % 3]));
            }
            for (std::size_t k = 0; k < 3; ++k)
                deform(corner[k]);
            if (parts > 1)
            {
                for (const Meeting& met : meetParts(_origin, _direction, *_chain, parts, flatOf(i)))
                    note(i, flatOf(i), met);
                continue;
            }
            const std::array<osg::Vec3d, 3> drawn = {deformed[corner[0]], deformed[corner[1]],
                                                     deformed[corner[2]]};
            if (curved)
            {
                followCurve(
                    {flatOf(i), drawn}, mostHalvings, *_chain, meetsBall,
                    [&](const Piece& piece) {
                        note(i, piece.flat,
                             meet(_origin, _direction, piece.drawn[0], piece.drawn[1], piece.drawn[2]));
                    });
            }
            else
            {
                const Meeting met = meet(_origin, _direction, drawn[0], drawn[1], drawn[2]);
                if (met.distance >= 0.0) note(i, flatOf(i), met);
            }
        }
    }
}

/// Keeps what is in force above a node.
class DeformedIntersectionVisitor::Scope
{
public:
    Scope(DeformedIntersectionVisitor& visitor, const osg::Node& node)
        : _visitor(visitor), _chain(visitor._chain), _radius(visitor._lodRadius), _limit(visitor._lodLimit),
          _deformation(visitor._deformation)
    {
        // The engine decides which of its programs deform; it is the same for all below the first node.
        if (visitor.getNodePath().size() == 1) visitor._programs->setHost(hostOf(node));
        visitor._deformation.meet(node.getStateSet());
        visitor.choose();
        if (visitor._chain == _chain) return;
        visitor.push_clone();
        _cloned = true;
    }
    ~Scope()
    {
        if (_cloned) _visitor.pop_clone();
        _visitor._chain = _chain;
        _visitor._lodRadius = _radius;
        _visitor._lodLimit = _limit;
        _visitor._deformation = _deformation;
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

private:
    DeformedIntersectionVisitor& _visitor;
    osg::ref_ptr<const DeformationChain> _chain;
    double _radius;
    double _limit;
    DeformationSwitch _deformation;
    bool _cloned = false;
};

DeformedIntersectionVisitor::DeformedIntersectionVisitor(osgUtil::Intersector* intersector,
                                                         const DeformationChain& chain,
                                                         const osg::Matrixd& modelView, double lodScale)
    : osgUtil::IntersectionVisitor(intersector), _chain(&chain), _whole(&chain),
      _nothing(new DeformationChain), _programs(std::make_unique<OwnPrograms>()), _view(modelView),
      _lodScale(lodScale), _lodLimit(HUGE_VAL)
{
    // The first one collects; from the second one on they know where they are.
    push_clone();
}

DeformedIntersectionVisitor::~DeformedIntersectionVisitor() = default;

osg::Matrixd DeformedIntersectionVisitor::modelView() const
{
    const osg::RefMatrix* model = getModelMatrix();
    return model ? osg::Matrixd(*model) * _view : _view;
}

void DeformedIntersectionVisitor::choose()
{
    _chain = _programs->isStranger(_deformation.program) ? _nothing.get() : &definedChain();
}

void DeformedIntersectionVisitor::apply(osg::Node& node)
{
    const Scope scope(*this, node);
    IntersectionVisitor::apply(node);
}

void DeformedIntersectionVisitor::apply(osg::Geode& node)
{
    const Scope scope(*this, node);
    // OSG's own way with geodes passes over what their drawables say of programs and defines.
    IntersectionVisitor::apply(static_cast<osg::Node&>(node));
}

void DeformedIntersectionVisitor::apply(osg::Group& node)
{
    if (auto* rigid = dynamic_cast<RigidReference*>(&node))
    {
        applyRigid(*rigid);
        return;
    }
    const Scope scope(*this, node);
    IntersectionVisitor::apply(node);
}

void DeformedIntersectionVisitor::applyRigid(RigidReference& node)
{
    const Scope scope(*this, node);
    const osg::Matrixd view = _view;
    const osg::Matrixd here = modelView();
    const osg::Vec3d reference = node.referencePoint() * here;
    if (definedChain().isBeyond(reference)) return;
    const osg::Matrixd placement = rigidPlacement(definedChain(), reference, node.getTurn());
    // Places on it are told as it stands, undeformed: only the view is moved.
    _view = _view * placement;
    _chain = _nothing;
    _deformation.on = false;
    _deformation.overridden = true;
    push_clone();
    IntersectionVisitor::apply(node);
    pop_clone();
    _view = view;
}

void DeformedIntersectionVisitor::apply(osg::Transform& node)
{
    const Scope scope(*this, node);
    IntersectionVisitor::apply(node);
}

void DeformedIntersectionVisitor::apply(osg::Billboard& node)
{
    const Scope scope(*this, node);
    if (!enter(node)) return;
    const osg::Matrixd fromEye = osg::Matrixd::inverse(_view);
    for (unsigned int i = 0; i < node.getNumDrawables(); ++i)
    {
        osg::Drawable* drawable = node.getDrawable(i);
        if (!drawable) continue;
        pushModelMatrix(new osg::RefMatrix(billboardModelView(*_chain, node, i, modelView()) * fromEye));
        push_clone();
        drawable->accept(*this);
        pop_clone();
        popModelMatrix();
    }
    leave();
}

void DeformedIntersectionVisitor::apply(osg::LOD& node)
{
    const Scope scope(*this, node);
    const osg::Matrixd here = modelView();
    _lodRadius = static_cast<double>(node.getBound().radius()) * largestScale(here);
    _lodLimit = _chain->lodLimit(node, {osg::Vec3d(node.getBound().center()) * here, _lodRadius});
    IntersectionVisitor::apply(static_cast<osg::Group&>(node));
}

void DeformedIntersectionVisitor::apply(osg::PagedLOD& node)
{
    apply(static_cast<osg::LOD&>(node));
}

void DeformedIntersectionVisitor::apply(osg::Drawable& drawable)
{
    if (GroundShade::is(drawable)) return;
    const Scope scope(*this, drawable);
    IntersectionVisitor::apply(drawable);
}

float DeformedIntersectionVisitor::getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const
{
    const double distance =
        _chain->lodDistance({osg::Vec3d(position) * modelView(), _lodRadius}, osg::Vec3d());
    return static_cast<float>(std::min(withLodScale ? distance * _lodScale : distance, _lodLimit));
}

} // namespace osgGeoFX
