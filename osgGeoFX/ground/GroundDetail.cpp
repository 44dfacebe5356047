// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/ground/GroundDetail.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/ground/detail/DetailNoise.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

enum Unit : std::size_t
{
    NoiseUnit,
    CoverUnit
};

/// Towards the light where the scene has none that fragments could know: from the northwest, half-way up.
const osg::Vec3d usualLight(-0.5, 0.5, 0.7071);
/// Trees grow up to this share of the snow line's height, as on panorama maps.
constexpr double treeShare = 0.8;

/// The frame on the ground below the eye, as a matrix to the world, and the ground's curvature there.
struct EyeFrame
{
    osg::Matrixd toWorld;
    double curvature = 0.0; ///< 1/metre

    explicit EyeFrame(const SurfaceView& view)
    {
        const osg::Vec3d eye = osg::Matrixd::inverse(view.modelView).getTrans();
        const osg::EllipsoidModel* ellipsoid = view.geometry.ground.ellipsoid;
        LocalOrigin origin = LocalOrigin::onPlane({eye.x(), eye.y()});
        if (ellipsoid)
        {
            double latitude = 0.0, longitude = 0.0, height = 0.0;
            ellipsoid->convertXYZToLatLongHeight(eye.x(), eye.y(), eye.z(), latitude, longitude, height);
            origin = LocalOrigin::onGlobe(longitude, latitude);
            curvature = 1.0 / ellipsoid->getRadiusEquator();
        }
        toWorld = origin.toWorld(ellipsoid);
    }
};

void set(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

void setTexture(osg::StateSet& state, const std::string& name, osg::Uniform::Type type, int unit,
                osg::Texture* texture)
{
    const auto place = static_cast<unsigned int>(unit);
    if (state.getTextureAttribute(place, osg::StateAttribute::TEXTURE) != texture)
        state.setTextureAttribute(place, texture);
    state.getOrCreateUniform(name, type)->set(unit);
}

} // namespace

GroundDetail::GroundDetail() : _noise(std::make_unique<DetailNoise>()) {}

GroundDetail::GroundDetail(const GroundDetail& other, const osg::CopyOp& copy)
    : SurfaceEffect(other, copy), TextureUser(other), _strength(other._strength), _relief(other._relief),
      _edges(other._edges), _largest(other._largest), _smallest(other._smallest), _treeLine(other._treeLine),
      _coverUnit(other._coverUnit), _noiseUnit(other._noiseUnit), _noise(std::make_unique<DetailNoise>())
{
}

GroundDetail::~GroundDetail() = default;

const Properties& GroundDetail::properties() const
{
    using Self = GroundDetail;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::number("strength", "how much of the detail is drawn", 0.0, 1.0)
                .of<&Self::_strength>()
                .turnedBy(0.1),
            Property::number("relief", "how much light and shade waves make", 0.0, 3.0).of<&Self::_relief>(),
            Property::number("edges", "how sharp borders of classes are; 0 leaves the texture's blur", 0.0,
                             1.0)
                .of<&Self::_edges>(),
            Property::number("largest", "the longest waves; longer than smallest", 1.0, 5000.0, "m")
                .of<&Self::_largest>(),
            Property::number("smallest", "the shortest waves; twelve octaves below largest at most", 0.05,
                             1000.0, "m")
                .of<&Self::_smallest>(),
            Property::number(
                "treeLine",
                "the height up to which woods are likely where nothing tells what grows; -1 takes "
                "it from the latitude",
                -1.0, 12000.0, "m")
                .of<&Self::_treeLine>(),
            Property::integer("coverUnit", "the texture unit where tiles say what lies on the ground", 4, 31)
                .of<&Self::_coverUnit>(),
            TextureUnits::property("noiseUnit", "the texture unit of the noise").of<&Self::_noiseUnit>(),
        });
    return all;
}

std::string GroundDetail::inconsistency() const
{
    if (_smallest >= _largest) return "smallest must be less than largest.";
    return TextureUnits::inconsistency(textureUnits());
}

std::vector<TextureUnitWish> GroundDetail::textureUnits() const
{
    return {{"noiseUnit", _noiseUnit, 18}, {"coverUnit", _coverUnit, _coverUnit, true, true}};
}

bool GroundDetail::fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view)
{
    const EyeFrame frame(view);
    const osg::Matrixd toFrame = osg::Matrixd::inverse(view.modelView) * osg::Matrixd::inverse(frame.toWorld);
    state.getOrCreateUniform(prefix + "toFrame", osg::Uniform::FLOAT_MAT4)->set(osg::Matrixf(toFrame));

    const double octaves = std::log(_largest / _smallest) / std::log(glsl::GEOFX_DETAIL_STEP);
    const int count = std::clamp(1 + static_cast<int>(octaves), 1, glsl::GEOFX_DETAIL_MOST);
    osg::Uniform& matrices = *state.getOrCreateUniform(prefix + "octaves", osg::Uniform::FLOAT_MAT4,
                                                       static_cast<unsigned int>(glsl::GEOFX_DETAIL_MOST));
    for (int i = 0; i < count; ++i)
    {
        const double wavelength = _largest / std::pow(glsl::GEOFX_DETAIL_STEP, i);
        osg::Matrixd toNoise = frame.toWorld * DetailNoise::octave(i, wavelength);
        // Of the eye's place only what is left within a period, or floats would have no digits for the waves.
        const osg::Vec3d place = toNoise.getTrans();
        toNoise.setTrans(place.x() - std::floor(place.x()), place.y() - std::floor(place.y()),
                         place.z() - std::floor(place.z()));
        matrices.setElement(static_cast<unsigned int>(i), osg::Matrixf(toNoise));
    }
    // A database of the kit says what lies on the ground wherever there is ground.
    const bool knownOnly = view.geometry.ground.terrain.valid();
    set(state, prefix + "waves", {double(count), _largest, frame.curvature, knownOnly ? 1.0 : 0.0});
    const double latitude = view.geometry.ground.ellipsoid
                                ? std::asin(std::clamp(view.geometry.up * view.geometry.polarAxis, -1.0, 1.0))
                                : view.geometry.ground.latitude;
    const double treeLine = _treeLine >= 0.0 ? _treeLine : treeShare * glsl::geofx_snowLine(latitude);
    set(state, prefix + "how", {_strength, _relief, _edges, treeLine});
    set(state, prefix + "sun", {usualLight, 0.0});

    setTexture(state, prefix + "noise", osg::Uniform::SAMPLER_3D, view.units[NoiseUnit], _noise->texture());
    setTexture(state, prefix + "cover", osg::Uniform::SAMPLER_2D, view.units[CoverUnit], _noise->noCover());
    state.getOrCreateUniform(prefix + "colors", osg::Uniform::SAMPLER_2D)->set(0);
    state.setDefine("GEOFX_DETAIL");
    return true;
}

void GroundDetail::resizeGLObjectBuffers(unsigned int size)
{
    _noise->resizeGLObjectBuffers(size);
}

void GroundDetail::releaseGLObjects(osg::State* state) const
{
    _noise->releaseGLObjects(state);
}

} // namespace osgGeoFX
