// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Image>
#include <osg/Texture2D>

namespace osgGeoFX
{

/** A raster of colors, values or classes that mappings show. Any number of mappings may share it.

    The image is an osg::Image of any uncompressed 2D format. Rows count from the bottom, as in OSG. A program may
    replace the image. An image that changes (osg::Image::dirty(), or an osg::ImageStream that plays) is uploaded
    again, the rows that differ alone; so a simulation may write it in each frame. The drawing may read the image at any
    time during a frame, so a program changes it only between frames. An image larger than a page of ProjectiveMappings
    is reduced, with a warning.
    @ingroup mapping */
class OSGGEOFX_EXPORT DataLayer : public PropertyHolder
{
public:
    DataLayer() = default;
    explicit DataLayer(osg::Image* image) : _image(image) {}
    DataLayer(const DataLayer& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, DataLayer);

    enum Kind
    {
        COLOR,
        VALUE, ///< the numbers of the first channel, averaged at a distance
        CLASS  ///< numbers that stand for something; at a distance the most frequent one is shown
    };
    /// The kind of data. Default: COLOR.
    bool setKind(Kind kind) { return assign("kind", kind); }
    Kind getKind() const { return static_cast<Kind>(_kind); }

    /// The raster. With a null pointer the layer shows nothing.
    void setImage(osg::Image* image);
    osg::Image* getImage() { return _image.get(); }
    const osg::Image* getImage() const { return _image.get(); }

    /// A texture that another pass fills on the GPU, such as a camera that is drawn before the scene. It takes the place of the
    /// image. Each frame copies it, within the GPU; what is drawn later in the same frame shows in the next one. The texture has
    /// a size (setTextureSize()) and colors; other kinds than COLOR show nothing, with a warning, and a color table may show
    /// their grey. Mappings with such a layer are never composed beforehand. Files do not have it. Default: none.
    void setTexture(osg::Texture2D* texture);
    osg::Texture2D* getTexture() { return _texture.get(); }
    const osg::Texture2D* getTexture() const { return _texture.get(); }

    /// Whether colors and values are interpolated between texels. Otherwise the nearest texel counts. Classes are
    /// never interpolated. Default: true.
    bool setSmooth(bool smooth) { return assign("smooth", smooth ? 1.0 : 0.0); }
    bool getSmooth() const { return _smooth; }
    /// Whether colors are sRGB-coded. If so, they are averaged in linear light. Default: true.
    bool setSRgb(bool coded) { return assign("sRgb", coded ? 1.0 : 0.0); }
    bool getSRgb() const { return _sRgb; }
    /// The value that means "no data", besides NaN and infinite numbers, which always do. Default: none.
    bool setNoData(double value) { return assign({{"noData", value}, {"hasNoData", 1.0}}); }
    bool clearNoData() { return assign("hasNoData", 0.0); }
    bool getHasNoData() const { return _hasNoData; }
    double getNoData() const { return _noData; }
    /// The layers of higher importance, 0…1, stay if the GPU has no room for all layers. Default: 0.5.
    bool setImportance(double importance) { return assign("importance", importance); }
    double getImportance() const { return _importance; }

    const Properties& properties() const override;

protected:
    ~DataLayer() override;

private:
    osg::ref_ptr<osg::Image> _image;
    osg::ref_ptr<osg::Texture2D> _texture;
    int _kind = COLOR;
    bool _smooth = true;
    bool _sRgb = true;
    bool _hasNoData = false;
    double _noData = 0.0;
    double _importance = 0.5;
};

} // namespace osgGeoFX
