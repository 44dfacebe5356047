// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/Texture2D>
#include <osg/Vec2d>

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/** A texture with the pictures of many names. Only what is new is uploaded. Any thread may draw with it while another one adds
    to it. */
class LabelAtlas
{
public:
    explicit LabelAtlas(int side = 2048);
    ~LabelAtlas();
    LabelAtlas(const LabelAtlas&) = delete;
    LabelAtlas& operator=(const LabelAtlas&) = delete;

    struct Place
    {
        int x = 0, y = 0, width = 0, height = 0; ///< texels
    };
    /// Where a name's picture is; empty if it has not been added.
    std::optional<Place> find(std::size_t name) const;
    /// Adds a picture of premultiplied RGBA. False if there is no room; then clear() makes some.
    bool add(std::size_t name, const osg::Image& picture);
    void clear();
    /// The middle of some opaque white texels.
    osg::Vec2d white() const { return osg::Vec2d(1.5, 1.5) / _side; }
    int side() const { return _side; }
    osg::Texture2D& texture() { return *_texture; }

private:
    class Upload;
    struct Shelf
    {
        int y, height, used;
    };
    void begin();

    const int _side;
    std::vector<Shelf> _shelves;
    std::unordered_map<std::size_t, Place> _places;
    osg::ref_ptr<Upload> _upload;
    osg::ref_ptr<osg::Texture2D> _texture;
};

} // namespace osgGeoFX
