// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Image>

namespace osgGeoFX
{

/** A raster that mappings show: colours, values, or classes. Any number of mappings may share it.

    The picture is an osg::Image of any uncompressed 2D format; rows count from the bottom, as OSG has them. It may be
    exchanged, and an image that changes (osg::Image::dirty(), an osg::ImageStream that plays) is uploaded anew.
    The picture may be read from while it is drawn: change it between frames. Pictures larger than
    ProjectiveMappings' page are reduced, with a warning. */
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
        VALUE, ///< the first channel's numbers as they are; averaged when seen from afar
        CLASS  ///< numbers that name something; the most frequent one is seen from afar
    };
    bool setKind(Kind kind) { return assign("kind", kind); }
    Kind getKind() const { return static_cast<Kind>(_kind); }

    /// Null shows nothing.
    void setImage(osg::Image* image);
    osg::Image* getImage() { return _image.get(); }
    const osg::Image* getImage() const { return _image.get(); }

    /// Between texels: smooth, or the nearest one. Smooth by default, of classes never.
    bool setSmooth(bool smooth) { return assign("smooth", smooth ? 1.0 : 0.0); }
    bool getSmooth() const { return _smooth; }
    /// Whether colours are coded as sRGB, which is how their averages are taken. True by default.
    bool setSRgb(bool coded) { return assign("sRgb", coded ? 1.0 : 0.0); }
    bool getSRgb() const { return _sRgb; }
    /// The value that means no data, beside NaN, which always does. None by default.
    bool setNoData(double value) { return assign({{"noData", value}, {"hasNoData", 1.0}}); }
    bool clearNoData() { return assign("hasNoData", 0.0); }
    bool getHasNoData() const { return _hasNoData; }
    double getNoData() const { return _noData; }
    /// 0…1: which layers stay where there is no room for all of them; ½ by default.
    bool setImportance(double importance) { return assign("importance", importance); }
    double getImportance() const { return _importance; }

    const Properties& properties() const override;

protected:
    ~DataLayer() override;

private:
    osg::ref_ptr<osg::Image> _image;
    int _kind = COLOR;
    bool _smooth = true;
    bool _sRgb = true;
    bool _hasNoData = false;
    double _noData = 0.0;
    double _importance = 0.5;
};

} // namespace osgGeoFX
