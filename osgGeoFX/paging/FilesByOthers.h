// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/observer_ptr>
#include <osgDB/Callbacks>
#include <osgDB/Options>
#include <osgDB/ReaderWriter>

#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace osgGeoFX
{

/** Reads the database and the pictures of a scene by somebody else, of whom nothing is known.

    osgDB chooses a plugin by a file's name, and some plugins run programs (`osgdb_lua`), fetch addresses or read other
    files. This class chooses the plugin by the first bytes of a file, among these formats and no others:
    - databases: `.osgb` (little-endian, plain or compressed by zlib), `.osgt`, and scenes (`.geofx`);
    - pictures: PNG, JPEG, GIF, BMP, DDS.

    All files must lie in a folder or below it. A database may hold objects of the libraries osg, osgAnimation, osgFX,
    osgParticle, osgShadow, osgSim, osgUtil and osgGeoFX. Scripts, image sequences (osg::ImageSequence) and objects of other
    libraries are refused, and a file with them as a whole. A picture has up to 256 MiB of pixels, and a database file up to 256 MiB
    when it is unpacked. A picture file that several objects name is read once, and they share it. A picture's header tells so before its pixels are unpacked; unpacking a database file ends there.

    As a ReadFileCallback it stands in the options that OSG's readers pass on, so it meets what these files name in their turn.
    Pictures within files go the same way (see Gate). A refusal is a ReadResult with a reason that is a part of a sentence.
    All functions may be called from any thread.

    @ingroup paging */
class OSGGEOFX_EXPORT FilesByOthers : public osgDB::ReadFileCallback
{
public:
    using ReadResult = osgDB::ReaderWriter::ReadResult;

    /// `folder`: a path or an address.
    explicit FilesByOthers(std::string folder);

    /// Those in the options; null if files are trusted.
    static FilesByOthers* of(const osgDB::Options* options);
    /// A copy of the options, which may be null, with these.
    osg::ref_ptr<osgDB::Options> addTo(const osgDB::Options* options);

    /// Whether a path lies in a folder or below it, links followed. An address does not, nor does a path that GDAL reads without
    /// a file. If the folder is an address, addresses below it do, and nothing else.
    static bool isWithin(const std::string& path, const std::string& folder);

    /// A picture, by its content. Null, with the reason, if it is of another format, too large or damaged.
    static osg::ref_ptr<osg::Image> readPicture(const std::string& path, std::string& reason);

    /// Why a file may not be read for the place where it lies, as a part of a sentence; empty if it may.
    std::string faultOfPlace(const std::string& path) const;

    ReadResult readNode(const std::string& file, const osgDB::Options* options) override;
    ReadResult readImage(const std::string& file, const osgDB::Options* options) override;
    // All other kinds of files are refused.
    ReadResult openArchive(const std::string& file, osgDB::ReaderWriter::ArchiveStatus status,
                           unsigned int indexBlockSizeHint, const osgDB::Options* options) override;
    ReadResult readObject(const std::string& file, const osgDB::Options* options) override;
    ReadResult readHeightField(const std::string& file, const osgDB::Options* options) override;
    ReadResult readShader(const std::string& file, const osgDB::Options* options) override;
    ReadResult readScript(const std::string& file, const osgDB::Options* options) override;

    /// A node from the bytes of a file. `name`: its path or address.
    ReadResult readBytes(std::string bytes, const std::string& name, const osgDB::Options* options);
    /// Lets a program's own callback read a file, if the file on the disk, where there is one, may be read.
    ReadResult readThrough(osgDB::ReadFileCallback& callback, const std::string& file,
                           const osgDB::Options* options);

    /** While one exists, OSG asks us for the readers of pictures that lie within files of others. Their names say nothing of
        the content, and osgDB would load a plugin by these names. A plugin has one as a static object. */
    class OSGGEOFX_EXPORT Gate
    {
    public:
        Gate();
        ~Gate();
        Gate(const Gate&) = delete;
        Gate& operator=(const Gate&) = delete;

    private:
        osg::ref_ptr<osgDB::ReaderWriter> _reader;
    };

    /** While one exists, its thread reads raster and vector data as somebody else's: files in a folder and below, in formats that
        lead nowhere else; it fetches and writes nothing (FileSources lists what osgGeoFXData reads then). Objects that read later,
        maybe in other threads, keep the folder of the scope in which they were made. Scopes may nest; the innermost holds. */
    class OSGGEOFX_EXPORT Scope
    {
    public:
        /// `folder`: a path or an address; nothing: data are trusted.
        explicit Scope(std::optional<std::string> folder);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

        /// Of this thread.
        static const std::optional<std::string>& folder();

    private:
        std::optional<std::string> _former;
    };

protected:
    ~FilesByOthers() override;

private:
    /// As long as it lives, the same one.
    osg::ref_ptr<osg::Image> sharedPicture(const std::string& path, std::string& reason);

    const std::string _folder;
    std::mutex _mutex;
    std::map<std::string, osg::observer_ptr<osg::Image>> _pictures; ///< by path
};

} // namespace osgGeoFX
