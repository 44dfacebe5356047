// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The wrapper of LayerPlayer, with its clock and its sequences, and what names files again.
// Callbacks have osg::Object as a virtual base, and OSG's serializers go by this.
#define OBJECT_CAST dynamic_cast

#include "LayerRequests.h"
#include "Wrappers.h"

#include <osgGeoFX/paging/PluginFolder.h>

#include <osg/Notify>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <algorithm>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Stands for vector data where a raster has its kind.
constexpr int vectorKind = 100;
/// Is added to the kind of a raster whose bands are written, too.
constexpr int withBands = 200;
/// The same, of a raster that is shown around its origin.
constexpr int withReach = 1000;

void writeBands(osgDB::OutputStream& stream, const RasterBands& bands)
{
    for (const RasterBands::Channel& channel : bands.channels)
    {
        stream << channel.band << channel.range.has_value();
        if (channel.range) stream << exactText(channel.range->first) << exactText(channel.range->second);
    }
}

RasterBands readBands(osgDB::InputStream& stream)
{
    RasterBands bands;
    for (RasterBands::Channel& channel : bands.channels)
    {
        bool hasRange = false;
        stream >> channel.band >> hasRange;
        channel.band = std::max(channel.band, 0);
        if (!hasRange) continue;
        const double black = readNumber(stream, "LayerSource");
        channel.range = {black, readNumber(stream, "LayerSource")};
    }
    return bands;
}

} // namespace

bool askForLayer(const std::string& service, void* request, std::string& error)
{
    addPluginFolder();
    osgDB::ReaderWriter* const plugin = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
    if (!plugin)
    {
        error = "the OSG plugin osgdb_geofxdata, which opens it, was not found; put its folder on "
                "OSG_LIBRARY_PATH.";
        return false;
    }
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("version", GEOFX_VERSION);
    options->setPluginData("request", request);
    const osgDB::ReaderWriter::ReadResult result = plugin->readObject(service, options.get());
    if (result.status() == osgDB::ReaderWriter::ReadResult::FILE_LOADED) return true;
    error = result.message().empty() ? "the OSG plugin osgdb_geofxdata is too old." : result.message();
    return false;
}

void writeSource(osgDB::OutputStream& stream, const LayerSource& source)
{
    stream.writeWrappedString(source.file);
    stream.writeWrappedString(source.wkt);
    const bool hasReach = source.reach > 0.0;
    const int kind = source.kind.value_or(-1) + (source.bands ? withBands : 0) + (hasReach ? withReach : 0);
    stream << source.globe << source.maxSide << (source.vectors ? vectorKind : kind);
    if (source.vectors)
    {
        stream.writeWrappedString(source.vectors->layer);
        stream.writeWrappedString(source.vectors->style);
        stream << source.vectors->allowOutside;
    }
    else if (source.bands)
        writeBands(stream, *source.bands);
    if (!source.vectors && hasReach) stream << exactText(source.reach);
    for (const double number :
         {source.origin.x, source.origin.y, source.origin.longitude, source.origin.latitude})
        stream << exactText(number);
    stream << std::endl;
}

LayerSource readSource(osgDB::InputStream& stream)
{
    LayerSource source;
    int kind = -1;
    stream.readWrappedString(source.file);
    stream.readWrappedString(source.wkt);
    stream >> source.globe >> source.maxSide >> kind;
    const bool hasReach = kind >= withReach - 1;
    if (hasReach) kind -= withReach;
    const bool hasBands = kind >= withBands - 1;
    if (hasBands) kind -= withBands;
    if (kind >= DataLayer::COLOR && kind <= DataLayer::CLASS) source.kind = kind;
    if (kind == vectorKind)
    {
        source.vectors = LayerSource::Vectors();
        stream.readWrappedString(source.vectors->layer);
        stream.readWrappedString(source.vectors->style);
        stream >> source.vectors->allowOutside;
    }
    if (hasBands) source.bands = readBands(stream);
    if (hasReach) source.reach = std::max(readNumber(stream, "LayerSource"), 0.0);
    for (double* const number :
         {&source.origin.x, &source.origin.y, &source.origin.longitude, &source.origin.latitude})
        *number = readNumber(stream, "LayerSource");
    return source;
}

namespace
{

const ImageSteps* imagesOf(const LayerSequence& sequence)
{
    return dynamic_cast<const ImageSteps*>(&sequence.steps());
}

bool isWritten(const LayerSequence& sequence)
{
    return imagesOf(sequence) || sequence.steps().source();
}

bool hasSequences(const LayerPlayer& player)
{
    bool any = false;
    for (unsigned int i = 0; i < player.getNumSequences(); ++i)
        any = any || isWritten(*player.getSequence(i));
    return any;
}

/// What a file has of a sequence before its layer and its images: in XML, nothing but objects may follow an object.
struct Head
{
    bool blending = true;
    bool hasImages = false;
    // Of images.
    int kind = DataLayer::COLOR;
    bool dated = false;
    std::vector<double> times;
    std::vector<bool> has;
    // Of files.
    LayerSource source;
};

void writeHead(osgDB::OutputStream& stream, const LayerSequence& sequence)
{
    const ImageSteps* const images = imagesOf(sequence);
    stream << sequence.getBlending() << (images != nullptr);
    if (!images) return writeSource(stream, *sequence.steps().source());
    const std::vector<double>& times = images->times();
    stream << static_cast<int>(images->kind()) << images->dated() << static_cast<unsigned int>(times.size());
    for (std::size_t i = 0; i < times.size(); ++i)
        stream << exactText(times[i]) << (images->getImage(i) != nullptr);
    stream << std::endl;
}

Head readHead(osgDB::InputStream& stream)
{
    Head head;
    stream >> head.blending >> head.hasImages;
    if (!head.hasImages)
    {
        head.source = readSource(stream);
        return head;
    }
    unsigned int count = 0;
    stream >> head.kind >> head.dated >> count;
    if (head.kind < DataLayer::COLOR || head.kind > DataLayer::CLASS) head.kind = DataLayer::COLOR;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        bool has = false;
        head.times.push_back(readNumber(stream, "LayerSequence"));
        stream >> has;
        head.has.push_back(has);
    }
    return head;
}

/// The images of a head, or its file. Null, with a sentence in `error`, if the file cannot be opened.
osg::ref_ptr<SequenceSteps> readSteps(osgDB::InputStream& stream, const Head& head, std::string& error)
{
    if (!head.hasImages)
    {
        LayerStepsRequest request{head.source, nullptr};
        return !stream.getException() && askForLayer("layerSteps", &request, error) ? request.steps : nullptr;
    }
    std::vector<osg::ref_ptr<osg::Image>> images;
    for (const bool has : head.has)
        images.push_back(has ? readImage(stream) : nullptr);
    return new ImageSteps(std::move(images), head.times, static_cast<DataLayer::Kind>(head.kind), head.dated);
}

bool writeSequences(osgDB::OutputStream& stream, const LayerPlayer& player)
{
    std::vector<const LayerSequence*> written;
    for (unsigned int i = 0; i < player.getNumSequences(); ++i)
        if (isWritten(*player.getSequence(i))) written.push_back(player.getSequence(i));
    stream << static_cast<unsigned int>(written.size()) << stream.BEGIN_BRACKET << std::endl;
    for (const LayerSequence* const sequence : written)
        writeHead(stream, *sequence);
    for (const LayerSequence* const sequence : written)
    {
        // Its layer has no other way out.
        stream.writeObject(const_cast<LayerSequence&>(*sequence).getLayer());
        const ImageSteps* const images = imagesOf(*sequence);
        for (std::size_t i = 0; images && i < images->times().size(); ++i)
            if (images->getImage(i)) stream.writeImage(images->getImage(i));
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

bool readSequences(osgDB::InputStream& stream, LayerPlayer& player)
{
    unsigned int count = 0;
    stream >> count >> stream.BEGIN_BRACKET;
    std::vector<Head> heads;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
        heads.push_back(readHead(stream));
    for (const Head& head : heads)
    {
        if (stream.getException()) break;
        const osg::ref_ptr<DataLayer> layer = stream.readObjectOfType<DataLayer>();
        std::string error;
        const osg::ref_ptr<SequenceSteps> steps = readSteps(stream, head, error);
        if (stream.getException()) break;
        if (!steps)
        {
            OSG_WARN << "osgGeoFX: A layer in time of a file stays as it is: " << error << std::endl;
            continue;
        }
        const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps, layer);
        sequence->setBlending(head.blending);
        player.add(sequence);
    }
    stream >> stream.END_BRACKET;
    return true;
}

/// A callback has no table of properties.
class PlayerWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    PlayerWrapper()
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return new LayerPlayer; },
                                            serializerDomain, "osgGeoFX::LayerPlayer",
                                            "osg::Object osg::Callback osgGeoFX::LayerPlayer", &add)
    {
    }

private:
    static void add(const char*, osgDB::ObjectWrapper* wrapper)
    {
        addPart<LayerPlayer, LayerClock, &LayerPlayer::getClock, &LayerPlayer::setClock>(*wrapper, "Clock");
        addOwn<LayerPlayer>(*wrapper, "Sequences", &hasSequences, &readSequences, &writeSequences);
    }
};

const PlayerWrapper playerWrapper;

} // namespace

} // namespace osgGeoFX
