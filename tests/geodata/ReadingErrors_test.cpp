// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What people are told of a failure to read, by the message of GDAL.
#include <osgGeoFX/geodata/detail/ReadingErrors.h>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

struct Message
{
    const char* text;
    const char* told;
    bool passes;
};

std::string blockOf(const std::string& code)
{
    return "GDALWMS: Unable to download block 0, 0.\nURL: http://host/1.png\n  HTTP status code: " + code +
           ", error: (null).\nAdd the HTTP status code to <ZeroBlockHttpCodes> to ignore this error";
}

} // namespace

TEST(ReadingErrors, EachCauseHasItsRemedy)
{
    const std::string busy = blockOf("503"), often = blockOf("429"), closed = blockOf("403"),
                      gone = blockOf("410");
    const std::string silent =
        "GDALWMS: Unable to download block 0, 0.\nURL: x\n  HTTP status code: 0, error: Could not "
        "resolve host: tile.example.\nAdd";
    const Message messages[] = {
        {busy.c_str(), " (the server has failed, HTTP 503); try again later", true},
        {often.c_str(), " (the server was asked too often, HTTP 429); wait some minutes, and try again",
         true},
        {closed.c_str(),
         " (the server refuses it, HTTP 403); check the key in its address, and the service's terms", false},
        {gone.c_str(), " (the server does not have it, HTTP 410); correct its address", false},
        {"HTTP error code : 404", " (the server does not have it, HTTP 404); correct its address", false},
        {"HTTP response code: 404", " (the server does not have it, HTTP 404); correct its address", false},
        {silent.c_str(),
         " (the server does not answer: Could not resolve host: tile.example); check the network and the "
         "address, and try "
         "again",
         true},
        {"CURL error: Failed to connect to host port 80",
         " (the server does not answer: Failed to connect to host port 80); check the network and the "
         "address, and try "
         "again",
         true},
        {"CURL error: Operation too slow",
         " (the server does not answer: Operation too slow); check the network and the address, "
         "and try again",
         false},
        {"PROJ: lcc: Invalid latitude",
         " (PROJ: lcc: Invalid latitude); a part of it lies where its coordinate reference system has no "
         "places: cut it "
         "with gdal_translate -projwin, or correct the system with gdal_translate -a_srs",
         false},
        {"`/home/a/.cache/0/1/0123456789abcdef0123456789abcdef' not recognized as a supported file format.",
         " (`/home/a/.cache/0/1/0123456789abcdef0123456789abcdef' not recognized as a supported file "
         "format); the service "
         "sends something that is no picture: check its address and its description",
         true},
        {"f.tif: TIFFReadEncodedTile() failed.", " (f.tif: TIFFReadEncodedTile() failed); usual", false},
        {"write failed: No space left on device",
         " (write failed: No space left on device); free some space on the disk", false},
    };
    for (const Message& each : messages)
    {
        EXPECT_EQ(causeAndRemedy(each.text, "usual"), each.told);
        EXPECT_EQ(mayPass(each.text), each.passes) << each.text;
    }
}

TEST(ReadingErrors, TheFirstFailureCountsAndMissingTilesAreNone)
{
    ReadingErrors errors;
    CPLError(CE_Warning, CPLE_AppDefined, "a warning");
    CPLError(CE_Failure, CPLE_AppDefined, "PROJ: tmerc: Invalid latitude");
    CPLError(CE_Failure, CPLE_OpenFailed,
             "/cache/0/1/0123456789abcdef0123456789abcdef: No such file or directory");
    CPLError(CE_Failure, CPLE_AppDefined, "GDALWMS: Unable to open downloaded block.");
    EXPECT_EQ(errors.message, "");
    CPLError(CE_Failure, CPLE_OpenFailed, "/data/f.tif: No such file or directory");
    CPLError(CE_Failure, CPLE_AppDefined, "a later one");
    EXPECT_EQ(errors.message, "/data/f.tif: No such file or directory");
}
