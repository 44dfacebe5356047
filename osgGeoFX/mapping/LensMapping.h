// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>
#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/NodeCallback>
#include <osg/Vec4>
#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

class EffectScene;

/** A lens that moves over the terrain (Trapp and Döllner 2009, Section 5, focus and context). Inside a soft outline
    with a rim it shows another mapping, or the scene in other colors.

    The content of the lens is a mapping that the program places but does not add to the ProjectiveMappings. The lens
    uses its layer, table, transfer, opacity and place. At each move the lens copies the part of the content's image
    below it and uploads it (`side`² texels). Content without a layer, for instance the scene's own colors through a
    color matrix, needs no upload. If lenses overlap, the lens of higher order lies on top. Of equal orders the later
    lens does.

    Places are in the mappings' frame, metres. The thread of the frame loop changes a lens, between frames. The
    destructor removes the lens's mappings. Setters refuse values out of range: they return false, warn once and change
    nothing.
    @ingroup mapping */
class OSGGEOFX_EXPORT LensMapping : public osg::Referenced
{
public:
    /// `order` is −1000…1000.
    explicit LensMapping(ProjectiveMappings& mappings, int order = 100);

    /// The content: a mapping of the projector PLANE, with any transform. The alpha of its colors counts. Values and
    /// classes are opaque. With a null pointer only the rim is drawn.
    void setContent(ProjectiveMapping* content);
    ProjectiveMapping* getContent() { return _content.get(); }
    /// A program calls this after it has changed the content or the image of the content's layer.
    void refresh();

    /// The center of the lens, metres, ±5e7. Default: (0, 0).
    bool setCenter(const osg::Vec2d& place);
    osg::Vec2d getCenter() const { return _center; }
    /// Half the width and half the height, metres, 0.001…1e7 (default: 500), and the direction of the upper edge,
    /// radians clockwise from the frame's y axis (default: 0).
    bool setSize(double halfWidth, double halfHeight, double heading = 0.0);
    /// A round or square lens: half the width and half the height are equal, metres.
    bool setRadius(double metres) { return setSize(metres, metres); }
    double getHalfWidth() const { return _halfWidth; }
    double getHalfHeight() const { return _halfHeight; }
    double getHeading() const { return _heading; }
    /// Sets center, size and heading together, so that the image is copied only once.
    bool place(const osg::Vec2d& center, double halfWidth, double halfHeight, double heading = 0.0);

    /// The look of the lens. Shares of the radius are shares of half the width and half the height.
    struct Style
    {
        bool round = true;     ///< an ellipse; if false, a rectangle
        double softness = 0.0; ///< share of the radius over which the content fades out, 0…1
        double rim = 0.02;     ///< width of the rim line as a share of the radius, 0…½
        osg::Vec4 rimColor = {1.0f, 1.0f, 1.0f, 0.95f};
        double shade = 0.06; ///< width of a soft dark edge outside the rim, as a share of the radius, 0…½
        double opacity = 1.0;
        int side = 256; ///< side of the copied image, texels, 16…2048
    };
    bool setStyle(const Style& style);
    const Style& getStyle() const { return _style; }
    /// −1000…1000. Default: the constructor's.
    bool setOrder(int order);
    bool setEnabled(bool enabled);

    /// The two mappings of the lens: the content, and the rim above it.
    ProjectiveMapping& inside() const { return *_inside; }
    ProjectiveMapping& rim() const { return *_rim; }

protected:
    ~LensMapping() override;

private:
    void draw();
    void cutOut();

    osg::ref_ptr<ProjectiveMappings> _host;
    osg::ref_ptr<ProjectiveMapping> _content, _inside, _rim;
    osg::ref_ptr<DataLayer> _mask, _rimLayer, _cut;
    osg::ref_ptr<ColorTransfer> _transfer;
    Style _style;
    osg::Vec2d _center;
    double _halfWidth = 500.0, _halfHeight = 500.0, _heading = 0.0;
    std::optional<LayerPixels> _pixels; ///< of the content's layer
};

/** An event handler that moves a lens along with the mouse pointer, over the ground as the effects deform it. Ctrl and
    the mouse wheel change the lens's size. One handler serves one view.
    @ingroup mapping */
class OSGGEOFX_EXPORT LensFollowsPointer : public osgGA::GUIEventHandler
{
public:
    /// `mappings` hosts the lens and must be an effect of `scene`. Half the width of the lens stays within the two
    /// limits, metres.
    LensFollowsPointer(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens,
                       double smallest = 50.0, double largest = 20000.0);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~LensFollowsPointer() override;

private:
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<ProjectiveMappings> _mappings;
    osg::ref_ptr<LensMapping> _lens;
    double _smallest, _largest;
};

/** An update callback that keeps a lens at the center of the bounding sphere of its node, for instance a vehicle in
    the scene.
    @ingroup mapping */
class OSGGEOFX_EXPORT LensFollowsNode : public osg::NodeCallback
{
public:
    LensFollowsNode(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens);

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~LensFollowsNode() override;

private:
    osg::observer_ptr<EffectScene> _scene; ///< the node may be below it
    osg::ref_ptr<ProjectiveMappings> _mappings;
    osg::ref_ptr<LensMapping> _lens;
};

} // namespace osgGeoFX
