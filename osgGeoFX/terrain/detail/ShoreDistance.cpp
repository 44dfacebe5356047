// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/ShoreDistance.h>

#include <osgGeoFX/terrain/detail/RowFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace osgGeoFX
{

namespace
{

constexpr double ENDLESS = std::numeric_limits<double>::infinity();
constexpr double FARTHEST = 1e6;
constexpr std::uint16_t NONE = 65535;

/// For each column, the last row with a cell of each kind, land or water.
class LastSeen
{
public:
    explicit LastSeen(int columns)
    {
        for (auto& rows : _rows)
            rows.assign(static_cast<std::size_t>(columns), NONE);
    }

    /// Adds a cell. The result is the nearest row behind it of the other kind.
    std::uint16_t pass(bool water, std::size_t column, int row)
    {
        _rows[water ? 1 : 0][column] = static_cast<std::uint16_t>(row);
        return _rows[water ? 0 : 1][column];
    }

private:
    std::array<std::vector<std::uint16_t>, 2> _rows;
};

/// Squared distances in a row, from squared distances in its columns: the lower envelope of parabolas.
class RowTransform
{
public:
    void run(const std::vector<double>& squares, double step, std::vector<double>& result)
    {
        const std::size_t count = squares.size();
        _sources.clear();
        _starts.clear();
        for (std::size_t q = 0; q < count; ++q)
        {
            if (squares[q] == ENDLESS) continue;
            double start = -ENDLESS;
            while (!_sources.empty())
            {
                const std::size_t v = _sources.back();
                const double xq = step * static_cast<double>(q), xv = step * static_cast<double>(v);
                start = ((squares[q] + xq * xq) - (squares[v] + xv * xv)) / (2.0 * (xq - xv));
                if (start > _starts.back()) break;
                _sources.pop_back();
                _starts.pop_back();
            }
            if (_sources.empty()) start = -ENDLESS;
            _sources.push_back(q);
            _starts.push_back(start);
        }
        result.assign(count, ENDLESS);
        if (_sources.empty()) return;
        std::size_t k = 0;
        for (std::size_t q = 0; q < count; ++q)
        {
            const double x = step * static_cast<double>(q);
            while (k + 1 < _sources.size() && _starts[k + 1] < x)
                ++k;
            const double dx = x - step * static_cast<double>(_sources[k]);
            result[q] = dx * dx + squares[_sources[k]];
        }
    }

private:
    std::vector<std::size_t> _sources;
    std::vector<double> _starts;
};

} // namespace

void findShoreDistances(const CellMask& water, const CellMetres& metres, const std::string& workFile,
                        const std::function<void(int row, const std::vector<float>& distances)>& visit)
{
    const auto columns = static_cast<std::size_t>(water.columns);
    RowFile below(workFile, columns * sizeof(std::uint16_t), RowFile::Mode::TEMPORARY);
    std::vector<std::uint16_t> others(columns);
    LastSeen northwards(water.columns), southwards(water.columns);
    for (int row = 0; row < water.rows; ++row)
    {
        for (std::size_t c = 0; c < columns; ++c)
            others[c] = northwards.pass(water.at(static_cast<int>(c), row), c, row);
        below.write(row, others.data());
    }

    // On a whole circle, half of the row is repeated on each side.
    const std::size_t lap = metres.wholeCircle ? columns - 1 : 0, margin = (lap + 1) / 2;
    std::vector<double> toWater(columns + 2 * margin), toLand(toWater), waterSquares, landSquares;
    std::vector<float> distances(columns);
    RowTransform transform;
    for (int row = water.rows - 1; row >= 0; --row)
    {
        below.read(row, others.data());
        const double here = metres.y[static_cast<std::size_t>(row)];
        const auto squareTo = [&](std::uint16_t other)
        {
            return other == NONE ? ENDLESS : std::pow(metres.y[other] - here, 2.0);
        };
        for (std::size_t c = 0; c < columns; ++c)
        {
            const bool wet = water.at(static_cast<int>(c), row);
            const double square = std::min(squareTo(others[c]), squareTo(southwards.pass(wet, c, row)));
            toLand[margin + c] = wet ? square : 0.0;
            toWater[margin + c] = wet ? 0.0 : square;
        }
        for (auto* row0 : {&toLand, &toWater})
            for (std::size_t k = 0; k < margin; ++k)
            {
                (*row0)[k] = (*row0)[k + lap];
                (*row0)[margin + columns + k] = (*row0)[margin + columns + k - lap];
            }
        const double stepX = metres.x[static_cast<std::size_t>(row)];
        const std::size_t next = static_cast<std::size_t>(row) + (row + 1 < water.rows ? 1 : 0);
        const double stepY = next > 0 ? metres.y[next] - metres.y[next - 1] : stepX;
        const double half = 0.5 * std::min(stepX, stepY);
        transform.run(toLand, stepX, landSquares);
        transform.run(toWater, stepX, waterSquares);
        for (std::size_t c = 0; c < columns; ++c)
        {
            const bool wet = water.at(static_cast<int>(c), row);
            const double square = wet ? landSquares[margin + c] : waterSquares[margin + c];
            const double distance = std::min(std::sqrt(square) - half, FARTHEST);
            distances[c] = static_cast<float>(wet ? distance : -distance);
        }
        visit(row, distances);
    }
}

} // namespace osgGeoFX
