// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace geofx::test
{

/// True in ./tests/run --full.
inline bool fullTest()
{
    const char* full = std::getenv("GEOFX_TEST_FULL");
    return full && std::string(full) == "1";
}

/** Random numbers for one sample of a property test. Sample i is the same in every run; to see a failed one
    alone, make Random(i) of the number that the failure prints. */
class Random
{
public:
    explicit Random(std::uint64_t sample) : _engine(sample) {}

    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(_engine);
    }
    /// Evenly distributed magnitudes between two positive numbers.
    double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_engine); }
    double sign() { return integer(0, 1) ? 1.0 : -1.0; }

private:
    std::mt19937_64 _engine;
};

/// How many samples a property test takes: few on each change, many in ./tests/run --full.
inline int sampleCount()
{
    return fullTest() ? 100000 : 5000;
}

/// What one of several tests takes of the samples that they share, so that none of them takes too long for ctest.
struct SampleRange
{
    SampleRange(int count, int part, int parts) : first(count * part / parts), end(count * (part + 1) / parts)
    {
    }
    int count() const { return end - first; }

    int first, end;
};

} // namespace geofx::test
