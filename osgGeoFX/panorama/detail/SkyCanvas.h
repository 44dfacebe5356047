// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// Numbers or colors on a strip that repeats in x and ends in y. For the library only.
template<class Value>
class SkyStrip
{
public:
    SkyStrip(int width, int height)
        : _width(width), _height(height),
          _values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    {
    }

    int width() const { return _width; }
    int height() const { return _height; }

    /// Takes any x. y is clamped to the strip.
    Value& at(int x, int y) { return _values[index(x, y)]; }
    const Value& at(int x, int y) const { return _values[index(x, y)]; }

    void fill(const Value& value) { std::fill(_values.begin(), _values.end(), value); }

private:
    std::size_t index(int x, int y) const
    {
        const int column = ((x % _width) + _width) % _width;
        return static_cast<std::size_t>(std::clamp(y, 0, _height - 1)) * static_cast<std::size_t>(_width) +
               static_cast<std::size_t>(column);
    }

    int _width;
    int _height;
    std::vector<Value> _values;
};

using SkyCanvas = SkyStrip<glm::vec3>;

/// Paints cumulus clouds, the far ones first, and wisps onto a sky. `haze` is the horizon's color.
void paintClouds(SkyCanvas& canvas, std::uint32_t seed, const glm::vec3& haze);

/// Paints a canvas again in strokes of a brush, which follow its picture.
void paintInStrokes(SkyCanvas& canvas, std::uint32_t seed);

} // namespace osgGeoFX
