// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/ReadingErrors.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t digits = 32;

bool isHexadecimal(char letter)
{
    return std::isxdigit(static_cast<unsigned char>(letter)) != 0;
}

/// Whether it is about a tile that a service has sent, or that lies in the cache of services: a name of 32 digits behind a slash.
bool namesTile(const std::string& text)
{
    if (text.find("/vsimem/wms/") != std::string::npos) return true;
    for (std::size_t slash = text.find('/'); slash != std::string::npos; slash = text.find('/', slash + 1))
    {
        const auto begin = text.begin() + static_cast<std::ptrdiff_t>(slash) + 1;
        const auto end = std::find_if_not(begin, text.end(), isHexadecimal);
        if (static_cast<std::size_t>(end - begin) == digits) return true;
    }
    return false;
}

bool isMissingTile(const std::string& text)
{
    const std::string end = ": No such file or directory";
    return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0 &&
           namesTile(text);
}

bool hasAny(const std::string& text, std::initializer_list<const char*> parts)
{
    return std::any_of(parts.begin(), parts.end(),
                       [&](const char* part) { return text.find(part) != std::string::npos; });
}

/// What a server has answered; 0 if it has not; nothing if the message is not of a server.
std::optional<int> codeOf(const std::string& message)
{
    const std::size_t http = message.find("HTTP ");
    const std::size_t code = http == std::string::npos ? http : message.find("code", http);
    const std::size_t number = code == std::string::npos ? code : message.find_first_of("0123456789", code);
    if (number != std::string::npos) return std::atoi(message.c_str() + number);
    if (hasAny(message, {"CURL error", "Could not resolve", "Couldn't resolve", "Could not connect",
                         "Failed to connect", "Couldn't connect", "Connection timed out",
                         "Operation timed out", "Operation too slow"}))
        return 0;
    return std::nullopt;
}

/// One line, without what GDAL advises.
std::string firstLine(const std::string& message)
{
    std::string line = message.substr(0, message.find('\n'));
    while (!line.empty() && (line.back() == '.' || line.back() == ' ' || line.back() == '\r'))
        line.pop_back();
    return line;
}

/// What curl says of a server that has not answered.
std::string silenceOf(const std::string& message)
{
    const std::string mark = "error: ";
    const std::size_t error = message.find(mark);
    return firstLine(error == std::string::npos ? message : message.substr(error + mark.size()));
}

std::string ofServer(int code, const std::string& message)
{
    const std::string name = "HTTP " + std::to_string(code);
    if (code == 0)
        return " (the server does not answer: " + silenceOf(message) +
               "); check the network and the address, and try again";
    if (code == 401 || code == 403 || code == 407)
        return " (the server refuses it, " + name +
               "); check the key in its address, and the service's terms";
    if (code == 429)
        return " (the server was asked too often, " + name + "); wait some minutes, and try again";
    if (code >= 500) return " (the server has failed, " + name + "); try again later";
    return " (the server does not have it, " + name + "); correct its address";
}

} // namespace

void CPL_STDCALL ReadingErrors::handle(CPLErr severity, CPLErrorNum, const char* text)
{
    auto* const errors = static_cast<ReadingErrors*>(CPLGetErrorHandlerUserData());
    if (severity < CE_Failure || !errors->message.empty()) return;
    // Of places that have none, such as the outer half of a cell that is centred on a pole, or a part of a picture beyond the globe.
    const std::string words = text;
    if (words.rfind("PROJ: ", 0) == 0 || words.rfind("Too many points", 0) == 0) return;
    const bool wasMissing = std::exchange(errors->_missing, isMissingTile(text));
    // GDAL says this of the same tile next.
    const bool isSame = wasMissing && std::string(text) == "GDALWMS: Unable to open downloaded block.";
    if (!errors->_missing && !isSame) errors->message = text;
}

std::string causeAndRemedy(const std::string& message, const std::string& usual)
{
    if (const std::optional<int> code = codeOf(message)) return ofServer(*code, message);
    const std::string reason = " (" + firstLine(message) + "); ";
    if (hasAny(message, {"PROJ: ", "failed to transform", "Invalid latitude", "Invalid longitude"}))
        return reason + "a part of it lies where its coordinate reference system has no places: cut it with "
                        "gdal_translate -projwin, or correct the system with gdal_translate -a_srs";
    if (hasAny(message, {"No space left"})) return reason + "free some space on the disk";
    if (hasAny(message, {"ut of memory", "annot allocate", "llocation failed"}))
        return reason + "free some memory";
    if (hasAny(message, {"Permission denied"})) return reason + "let the file be read, with chmod";
    if (hasAny(message, {"GDALWMS: "}) || namesTile(message))
        return reason +
               "the service sends something that is no picture: check its address and its description";
    if (hasAny(message, {"No such file or directory"}))
        return reason + "put that file there, or correct its name in this one";
    return reason + usual;
}

std::string refusalOf(const std::string& file, const std::string& kind, const std::string& message,
                      const std::string& usual)
{
    if (message == file + ": No such file or directory")
        return file + ": there is no such file; check the path";
    VSIStatBufL status;
    if (VSIStatL(file.c_str(), &status) == 0 && VSI_ISREG(status.st_mode) && status.st_size == 0)
        return file + ": the file is empty; fetch or export it again";
    return file + ": it is not " + kind + " that GDAL can read" + causeAndRemedy(message, usual);
}

bool mayPass(const std::string& message)
{
    if (hasAny(message, {"timed out", "too slow"})) return false;
    if (const std::optional<int> code = codeOf(message)) return *code == 0 || *code == 429 || *code >= 500;
    // Half of a tile is known by its decoder's message alone.
    return hasAny(message, {"GDALWMS: ", "libpng: ", "libjpeg: "}) || namesTile(message);
}

} // namespace osgGeoFX
