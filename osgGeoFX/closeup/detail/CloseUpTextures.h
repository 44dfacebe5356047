// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUp.h>
#include <osgGeoFX/closeup/SurfaceData.h>
#include <osgGeoFX/closeup/detail/CloseUpItem.h>

#include <osg/Texture2D>
#include <osg/Texture2DArray>

#include <mutex>
#include <vector>

namespace osgGeoFX
{

/** The textures that all cameras share: masks, tables and surface data. A change makes a new texture, since the
    former one may be on its way to the screen. Thread-safe. */
class CloseUpTextures
{
public:
    static constexpr int tableWidth = 256;

    /// The textures at one time.
    struct State
    {
        osg::ref_ptr<osg::Texture2DArray> masks;
        osg::ref_ptr<osg::Texture2D> tables;
        osg::ref_ptr<osg::Texture2DArray> surfaces; ///< never null; one empty texel if there is no data
        int normalLayer = -1;
        std::vector<CloseUpItem::Places> places; ///< for each close-up
    };
    using CloseUpList = std::vector<osg::ref_ptr<CloseUp>>;
    State update(const CloseUpList& closeUps, const SurfaceData* data);
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    void updateMasks(const CloseUpList& closeUps);
    void updateSurfaces(const SurfaceData* data);
    void updateTables(const CloseUpList& closeUps, const SurfaceData* data);

    mutable std::mutex _mutex;
    State _state;
    std::vector<osg::ref_ptr<const osg::Image>> _maskImages;
    const SurfaceData* _data = nullptr;
    unsigned int _dataRevision = 0;
    std::vector<unsigned int> _imageCounts;
    std::vector<std::pair<double, double>> _ranges; ///< of the values of the surface layers
    std::vector<osg::Vec4ub> _tableTexels;
};

} // namespace osgGeoFX
