// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <vector>

namespace osgGeoFX
{

/** The fence between a region on the ground and its close-up, in the close-up's colour (paper: interactive close-ups,
    Section II.D).

    It is transparent by a table over the normalised height: 0 at the ground, 1 at the close-up. Changed by the thread of
    the frame loop between frames; reading is thread-safe. */
class OSGGEOFX_EXPORT Anchor : public PropertyHolder
{
public:
    Anchor();
    Anchor(const Anchor& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, Anchor);

    enum Kind
    {
        NONE,
        STRETCHED, ///< the terrain's triangles between ground and close-up (the paper); it needs many vertices
        CONTOUR    ///< a wall along the region's border, which needs none
    };
    /// CONTOUR by default.
    bool setKind(Kind kind) { return assign("kind", kind); }
    Kind getKind() const { return static_cast<Kind>(_kind); }

    /// The ready tables: the paper's Figure 4 and more.
    enum Style
    {
        SOLID,   ///< 1 everywhere
        VEIL,    ///< 0.35 everywhere
        RISING,  ///< clear at the ground, solid at the close-up
        FALLING, ///< solid at the ground, clear at the close-up
        ENDS,    ///< solid at both ends, clear between
        MIDDLE,  ///< clear at both ends
        RINGS,   ///< eight bands
        TABLE    ///< what setTable() was given
    };
    /// FALLING by default.
    bool setStyle(Style style) { return assign("style", style); }
    Style getStyle() const { return static_cast<Style>(_style); }
    /// Opacities at even steps from the ground to the close-up, 2…256 values of 0…1; sets the style to TABLE.
    bool setTable(const std::vector<float>& opacities);
    const std::vector<float>& getTable() const { return _table; }

    /// Of all of it, 0…1; 0.8 by default.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// Width of the line around the region on the ground and around the close-up, pixels, 0…64; 0 for none. 2 by default.
    bool setLineWidth(double pixels) { return assign("lineWidth", pixels); }
    double getLineWidth() const { return _lineWidth; }

    /// The opacity at a normalised height, 0…1, with `opacity` in it: linear between the table's values.
    double opacityAt(double height) const;

    const Properties& properties() const override;

protected:
    ~Anchor() override;

private:
    int _kind = CONTOUR;
    int _style = FALLING;
    double _opacity = 0.8, _lineWidth = 2.0;
    std::vector<float> _table = {1.0f, 0.0f};
};

} // namespace osgGeoFX
