// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <gdal_priv.h>

#include <string>

namespace osgGeoFX
{

/** The first failure on this thread while it lives, for GDAL's warper tells of it in no other way; nothing of it goes to the terminal.

    A tile that a service does not have, at the border of its layer, is none, though GDAL says that its copy in the cache, a name of 32 digits, is
    not there. A place that PROJ cannot transform has no pixel, and takes none from the others. GDAL's handlers are a stack for each thread, so these
    nest. */
class ReadingErrors
{
public:
    ReadingErrors() { CPLPushErrorHandlerEx(&handle, this); }
    ~ReadingErrors() { CPLPopErrorHandler(); }
    ReadingErrors(const ReadingErrors&) = delete;
    ReadingErrors& operator=(const ReadingErrors&) = delete;

    std::string message;

private:
    bool _missing = false; ///< that was the last failure

    static void CPL_STDCALL handle(CPLErr severity, CPLErrorNum, const char* text);
};

/// " (REASON); REMEDY": the end of a sentence about a file that GDAL cannot open or read, without its full stop, by the message of GDAL. `usual`:
/// the remedy where the message is of no cause that is known here.
std::string causeAndRemedy(const std::string& message, const std::string& usual);

/// The sentence, without its full stop, on a file that GDAL cannot open, by the message of GDAL. `kind`: "a raster", "vector data".
std::string refusalOf(const std::string& file, const std::string& kind, const std::string& message,
                      const std::string& usual);

/// Whether a message of GDAL's is of a service or its cache, and another try may do soon: the server has failed, was asked too often or sent half
/// of a tile, or the copy of a tile is broken, which GDAL fetches anew. Not where a server has kept us waiting.
bool mayPass(const std::string& message);

} // namespace osgGeoFX
