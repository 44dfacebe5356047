// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/LayerAtlas.h>

#include <osg/GLExtensions>

namespace osgGeoFX
{

/** Copies textures into slots of a texture array, within the GPU, with the levels of the slots. While it lives, frame buffers
    of its own are bound; afterwards the former ones are. For the thread that draws in a context. */
class SlotCopy
{
public:
    explicit SlotCopy(const osg::GLExtensions& gl);
    ~SlotCopy();
    SlotCopy(const SlotCopy&) = delete;
    SlotCopy& operator=(const SlotCopy&) = delete;

    /// The lowest level of a texture fills `width` x `height` texels of the slot; the rest repeats its last column and row.
    /// Both are names of OpenGL's.
    void copy(unsigned int texture, int width, int height, unsigned int array,
              const LayerAtlas::Slot& slot) const;

private:
    struct Box
    {
        int x0, y0, x1, y1;
    };
    void blit(const Box& from, const Box& to, unsigned int filter) const;

    const osg::GLExtensions& _gl;
    unsigned int _buffers[2] = {};
    int _read = 0, _drawn = 0; ///< those that were bound
    bool _scissor = false;
};

} // namespace osgGeoFX
