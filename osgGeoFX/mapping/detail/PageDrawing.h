// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/mapping/detail/PageResidency.h>

#include <osg/FrameBufferObject>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2D>
#include <osg/Viewport>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The texture of a camera's pages, and the stage that draws parts of them before the scene: all mappings over a place, as
    the fragments of the scene would blend them. For one thread at a time. */
class PageDrawing
{
public:
    /// A texture of at most so many mebibytes and of at most so many texels along its sides; at least 4 pages.
    PageDrawing(int megabytes, int side);
    ~PageDrawing();
    PageDrawing(const PageDrawing&) = delete;
    PageDrawing& operator=(const PageDrawing&) = delete;

    int megabytes() const { return _megabytes; }
    /// Texels along its longer side.
    int side() const { return std::max(_columns, _rows) * MappingPage::side; }
    int columns() const { return _columns; }
    int rows() const { return _rows; }
    int slots() const { return _columns * _rows; }
    osg::Texture2D* texture() const { return _texture; }

    /// Draws these parts of pages, and slot 0 the first time. `blank`: a place where no mapping lies.
    void draw(const ScenePass& pass, const std::vector<PageResidency::Piece>& pieces,
              const osg::Vec2d& blank);
    /// Whether all that draw() was told to draw has been drawn, in the context of this camera. What it drew is lost otherwise.
    bool holds(const ScenePass& pass) const;
    /// The texture is blank again.
    void forget();

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int size);

private:
    class Count;
    void makeState(const std::string& prefix);
    void addPiece(const PageResidency::Piece& piece);

    const int _megabytes;
    int _columns = 0, _rows = 0;
    osg::ref_ptr<osg::Texture2D> _texture;
    osg::ref_ptr<osg::FrameBufferObject> _target;
    osg::ref_ptr<osg::Viewport> _viewport;
    osg::ref_ptr<osgUtil::RenderStage> _stage;
    osg::ref_ptr<osg::Geometry> _geometry;
    osg::ref_ptr<osg::Vec4Array> _vertices;
    osg::ref_ptr<osg::DrawArrays> _quads;
    osg::ref_ptr<osg::StateSet> _state;
    std::string _prefix;
    osg::ref_ptr<Count> _drawn;
    std::optional<unsigned int> _before; ///< the count when draw() was called last
    unsigned int _context = 0;
    bool _blank = false; ///< whether slot 0 is drawn
};

} // namespace osgGeoFX
