// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/CsvLines.h>

namespace osgGeoFX
{

std::vector<int> recordLines(std::istream& stream)
{
    std::vector<int> lines;
    bool quoted = false, blank = true;
    int line = 1, start = 1;
    for (char c = '\n'; stream.get(c);)
    {
        if (c == '"') quoted = !quoted;
        if (c != '\n' && c != '\r')
        {
            if (blank) start = line;
            blank = false;
        }
        if (c != '\n') continue;
        ++line;
        if (!quoted && !blank) lines.push_back(start);
        blank = blank || !quoted;
    }
    lines.push_back(blank ? line : start);
    return lines;
}

} // namespace osgGeoFX
