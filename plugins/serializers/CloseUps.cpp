// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the close-ups and of what they are made of.
#include "Wrappers.h"

#include <osgGeoFX/closeup/CloseUps.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

/// Numbers in brackets behind their count.
template<typename Number>
void writeNumbers(osgDB::OutputStream& stream, const std::vector<Number>& numbers)
{
    stream << static_cast<unsigned int>(numbers.size()) << stream.BEGIN_BRACKET << std::endl;
    for (const Number number : numbers)
        stream << exactText(static_cast<double>(number));
    stream << std::endl << stream.END_BRACKET << std::endl;
}

std::vector<double> readNumbers(osgDB::InputStream& stream, const char* className)
{
    unsigned int count = 0;
    stream >> count >> stream.BEGIN_BRACKET;
    std::vector<double> numbers;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
        numbers.push_back(readNumber(stream, className));
    stream >> stream.END_BRACKET;
    return numbers;
}

bool hasTable(const Anchor& anchor)
{
    static const osg::ref_ptr<const Anchor> plain = new Anchor;
    return anchor.getTable() != plain->getTable();
}

bool readTable(osgDB::InputStream& stream, Anchor& anchor)
{
    const std::vector<double> numbers = readNumbers(stream, "Anchor");
    if (stream.getException()) return false;
    std::vector<float> opacities;
    std::transform(numbers.begin(), numbers.end(), std::back_inserter(opacities),
                   [](double number) { return static_cast<float>(number); });
    // The table may be one that the style does not use. A refusal has its own warning.
    const Anchor::Style style = anchor.getStyle();
    anchor.setTable(opacities);
    anchor.setStyle(style);
    return true;
}

bool writeTable(osgDB::OutputStream& stream, const Anchor& anchor)
{
    writeNumbers(stream, anchor.getTable());
    return true;
}

void addTable(osgDB::ObjectWrapper& wrapper)
{
    addOwn<Anchor>(wrapper, "Table", &hasTable, &readTable, &writeTable);
}

bool hasOutline(const RegionOfInterest& region)
{
    static const osg::ref_ptr<const RegionOfInterest> plain = new RegionOfInterest;
    return region.getOutline() != plain->getOutline();
}

bool readOutline(osgDB::InputStream& stream, RegionOfInterest& region)
{
    const std::vector<double> numbers = readNumbers(stream, "RegionOfInterest");
    if (stream.getException()) return false;
    if (numbers.size() % 2 != 0)
    {
        OSG_WARN << "osgGeoFX: A file is wrong: RegionOfInterest: Outline needs x and y of each corner. "
                    "The default stays."
                 << std::endl;
        return true;
    }
    std::vector<osg::Vec2d> corners;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
        corners.emplace_back(numbers[i], numbers[i + 1]);
    region.setOutline(corners);
    return true;
}

bool writeOutline(osgDB::OutputStream& stream, const RegionOfInterest& region)
{
    std::vector<double> numbers;
    for (const osg::Vec2d& corner : region.getOutline())
        numbers.insert(numbers.end(), {corner.x(), corner.y()});
    writeNumbers(stream, numbers);
    return true;
}

void addOutlineAndImage(osgDB::ObjectWrapper& wrapper)
{
    addOwn<RegionOfInterest>(wrapper, "Outline", &hasOutline, &readOutline, &writeOutline);
    addImage<RegionOfInterest, &RegionOfInterest::getImage, &RegionOfInterest::setImage>(wrapper, "Image");
}

// In the order of SurfaceData::Kind.
constexpr const char* layerKinds[] = {"COLOR",  "HEIGHT",    "NORMAL", "SLOPE",
                                      "ASPECT", "OCCLUSION", "CLASS",  "VALUE"};

bool hasLayers(const SurfaceData& data)
{
    return data.getNumLayers() > 0;
}

bool readLayers(osgDB::InputStream& stream, SurfaceData& data)
{
    unsigned int count = 0;
    stream >> count >> stream.BEGIN_BRACKET;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        std::string kind, name;
        stream >> kind;
        stream.readWrappedString(name);
        stream >> stream.BEGIN_BRACKET;
        const osg::ref_ptr<osg::Image> image = readImage(stream);
        stream >> stream.END_BRACKET;
        if (stream.getException()) return false;
        const auto* end = std::end(layerKinds);
        const auto* found = std::find(std::begin(layerKinds), end, kind);
        // A refusal has its own warning.
        if (found != end)
            data.addLayer(name, static_cast<SurfaceData::Kind>(found - std::begin(layerKinds)), image);
        else
            OSG_WARN << "osgGeoFX: A file is wrong: SurfaceData: the kind of layer \"" << name
                     << "\" must be COLOR, HEIGHT, NORMAL, SLOPE, ASPECT, OCCLUSION, CLASS or VALUE, not \""
                     << kind << "\". It is left out." << std::endl;
    }
    stream >> stream.END_BRACKET;
    return true;
}

bool writeLayers(osgDB::OutputStream& stream, const SurfaceData& data)
{
    stream << static_cast<unsigned int>(data.getNumLayers()) << stream.BEGIN_BRACKET << std::endl;
    for (int layer = 0; layer < data.getNumLayers(); ++layer)
    {
        stream << std::string(layerKinds[data.getLayerKind(layer)]);
        stream.writeWrappedString(data.getLayerName(layer));
        stream << stream.BEGIN_BRACKET << std::endl;
        stream.writeImage(data.getLayerImage(layer));
        stream << stream.END_BRACKET << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

void addLayers(osgDB::ObjectWrapper& wrapper)
{
    addOwn<SurfaceData>(wrapper, "Layers", &hasLayers, &readLayers, &writeLayers);
}

void addCloseUpParts(osgDB::ObjectWrapper& wrapper)
{
    using Self = CloseUp;
    addPart<Self, RegionOfInterest, &Self::getRegion, &Self::setRegion>(wrapper, "Region");
    addPart<Self, Anchor, &Self::getAnchor, &Self::setAnchor>(wrapper, "Anchor");
    addPart<Self, ColorTable, &Self::getTable, &Self::setTable>(wrapper, "Table");
    wrapper.addSerializer(
        new osgDB::StringSerializer<Self>("Surface", "", &Self::getSurface, &Self::setSurface),
        osgDB::BaseSerializer::RW_STRING);
}

void addCloseUps(osgDB::ObjectWrapper& wrapper)
{
    using Self = CloseUps;
    addPart<Self, SurfaceData, &Self::getSurfaceData, &Self::setSurfaceData>(wrapper, "SurfaceData");
    addParts<Self, CloseUp, &Self::getNumCloseUps, &Self::getCloseUp, &Self::addCloseUp>(wrapper, "CloseUps");
}

const Wrapper<Anchor, addTable> anchorWrapper("osgGeoFX::Anchor", "osg::Object osgGeoFX::Anchor");
const Wrapper<RegionOfInterest, addOutlineAndImage> regionWrapper("osgGeoFX::RegionOfInterest",
                                                                  "osg::Object osgGeoFX::RegionOfInterest");
const Wrapper<SurfaceData, addLayers> dataWrapper("osgGeoFX::SurfaceData",
                                                  "osg::Object osgGeoFX::SurfaceData");
const Wrapper<CloseUp, addCloseUpParts> closeUpWrapper("osgGeoFX::CloseUp", "osg::Object osgGeoFX::CloseUp");
const Wrapper<CloseUps, addCloseUps> closeUpsWrapper("osgGeoFX::CloseUps",
                                                     "osg::Object osgGeoFX::Effect osgGeoFX::CloseUps");

} // namespace

} // namespace osgGeoFX
