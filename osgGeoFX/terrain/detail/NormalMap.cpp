// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/NormalMap.h>

#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/TileNormals.h>

#include <osg/Image>
#include <osg/Math>
#include <osg/Program>
#include <osg/TexGen>
#include <osg/TexMat>
#include <osg/Texture2D>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

// Above this, z follows from x and y. Below, an error of theirs would become a much larger one of z.
constexpr double LEAST_Z = 0.2;

// The same set as in stages/tile.frag.
constexpr unsigned int VERTEX_NORMAL_SET = 6;

unsigned char encoded(double value)
{
    return static_cast<unsigned char>(std::lround(value * 127.0) + 128);
}

/// The directions east, north and up in a tile's frame. Sines and cosines are computed once for each row and column.
class LatticeAxes
{
public:
    LatticeAxes(const TilingScheme& scheme, const TileKey& key, double spacing, int size)
        : _geographic(scheme.crs.geographic)
    {
        if (!_geographic) return;
        const TileFrame frame(scheme, key);
        _middle = angle(frame.centerY());
        for (int i = 0; i < size; ++i)
        {
            _columns.push_back(angle(scheme.gridX(scheme.firstColumn(key) + i * spacing) - frame.centerX()));
            _rows.push_back(angle(scheme.gridY(scheme.firstRow(key) + i * spacing)));
        }
    }

    /// The normal of ground with these slopes to the east and to the north.
    osg::Vec3d normal(int column, int row, double slopeX, double slopeY) const
    {
        osg::Vec3d result(-slopeX, -slopeY, 1.0);
        if (_geographic)
        {
            const auto [sinX, cosX] = _columns[static_cast<std::size_t>(column)];
            const auto [sinY, cosY] = _rows[static_cast<std::size_t>(row)];
            // In a frame about the Earth's axis whose x axis points to the tile's meridian. Then it is turned about
            // the east.
            const osg::Vec3d east(-sinX, cosX, 0.0), north(-sinY * cosX, -sinY * sinX, cosY),
                up(cosY * cosX, cosY * sinX, sinY);
            const osg::Vec3d v = up - east * slopeX - north * slopeY;
            const auto [sine, cosine] = _middle;
            result.set(v.y(), cosine * v.z() - sine * v.x(), cosine * v.x() + sine * v.z());
        }
        result.normalize();
        return result;
    }

private:
    using Angle = std::array<double, 2>; ///< sine and cosine

    static Angle angle(double degrees)
    {
        const double radians = osg::DegreesToRadians(degrees);
        return {std::sin(radians), std::cos(radians)};
    }

    const bool _geographic;
    Angle _middle{};
    std::vector<Angle> _columns, _rows;
};

osg::ref_ptr<osg::Image> normalImage(const TilingScheme& scheme, const TileKey& key,
                                     const LevelArrays& arrays, int x, int y)
{
    const int n = arrays.normals, size = n + 1;
    const double spacing = static_cast<double>(scheme.intervals) * scheme.step(key.level) / n;
    const LatticeAxes axes(scheme, key, spacing, size);
    const auto stride = static_cast<std::size_t>(arrays.span * n + 1);
    std::vector<osg::Vec3d> normals;
    normals.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    double leastZ = 1.0;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
        {
            const std::size_t index =
                static_cast<std::size_t>(y * n + row) * stride + static_cast<std::size_t>(x * n + column);
            normals.push_back(axes.normal(column, row, static_cast<double>(arrays.texelSlopeX[index]),
                                          static_cast<double>(arrays.texelSlopeY[index])));
            leastZ = std::min(leastZ, normals.back().z());
        }
    const bool two = leastZ > LEAST_Z;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, two ? GL_RG : GL_RGB, GL_UNSIGNED_BYTE, 1);
    image->setInternalTextureFormat(two ? GL_RG8 : GL_RGB8);
    unsigned char* byte = image->data();
    for (const osg::Vec3d& normal : normals)
        for (int channel = 0; channel < (two ? 2 : 3); ++channel)
            *byte++ = encoded(normal[channel]);
    return image;
}

} // namespace

void addNormalMap(osg::StateSet& state, TileTextures& textures, const TilingScheme& scheme,
                  const TileKey& key, const LevelArrays& arrays, int x, int y)
{
    const osg::ref_ptr<osg::Image> image = normalImage(scheme, key, arrays, x, y);
    // Images of three channels are not compressed. For these there is BC1 alone, whose error is up to a third of the
    // whole range.
    osg::ref_ptr<osg::Texture2D> normals = new osg::Texture2D(
        image->getPixelFormat() == GL_RG ? textures.picture(image) : textures.data(image, true));
    normals->setName(TileNormals::texture);
    normals->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    normals->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    normals->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    normals->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    normals->setResizeNonPowerOfTwoHint(false);
    state.setTextureAttribute(TileNormals::unit, normals);

    // Texture coordinates place the centers of the first and the last texel on the borders. So they depend on the
    // number of texels.
    const int colors = scheme.textureIntervals(key.level), n = arrays.normals;
    if (colors == n) return;
    const double each = static_cast<double>(n) / colors, size = scheme.textureSize(n);
    const double scale = each * scheme.textureSize(colors) / size;
    const double offset = 0.5 / size * (1.0 - each);
    state.setTextureAttribute(
        TileNormals::unit,
        new osg::TexMat(osg::Matrix::scale(scale, scale, 1.0) * osg::Matrix::translate(offset, offset, 0.0)));
}

void addTileProgram(osg::StateSet& state)
{
    // The baked text, not that of a folder, so that a database's bytes follow from its options.
    const ShaderLibrary library{std::filesystem::path()};
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName(TileNormals::program);
    program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/tile.frag"));
    state.setAttributeAndModes(program);
    // The fixed functions hand on the vertices' normals as texture coordinates of a set that nothing else uses.
    osg::ref_ptr<osg::TexGen> generator = new osg::TexGen;
    generator->setMode(osg::TexGen::NORMAL_MAP);
    state.setTextureAttribute(VERTEX_NORMAL_SET, generator);
    for (const GLenum mode : {GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R})
        state.setTextureMode(VERTEX_NORMAL_SET, mode, osg::StateAttribute::ON);
    state.addUniform(new osg::Uniform("geofx_tileColors", 0));
    state.addUniform(new osg::Uniform("geofx_tileNormals", static_cast<int>(TileNormals::unit)));
}

} // namespace osgGeoFX
