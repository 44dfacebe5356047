// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace geofx::bench
{

namespace
{

/// Three significant figures, and all digits before the point.
std::string number(double value)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    const double size = std::abs(value);
    const bool whole = size >= 100.0 || value == std::round(value);
    text << std::fixed << std::setprecision(whole ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3) << value;
    return text.str();
}

std::string withUnit(double value, const std::string& unit)
{
    return number(value) + (unit.empty() ? "" : " " + unit);
}

std::string asked(const Figure& figure)
{
    switch (figure.bound)
    {
    case Bound::None:
        return "-";
    case Bound::Below:
        return "< " + withUnit(figure.asked, figure.unit);
    case Bound::AtMost:
        return "<= " + withUnit(figure.asked, figure.unit);
    default:
        return ">= " + withUnit(figure.asked, figure.unit);
    }
}

std::string verdict(const Figure& figure)
{
    const std::optional<bool> reached = figure.reached();
    if (!reached) return "";
    return *reached ? "reached" : figure.measured ? "FALLS SHORT" : "NOT MEASURED";
}

} // namespace

bool allReached(const std::vector<SuiteResult>& results)
{
    return std::all_of(results.begin(), results.end(),
                       [](const SuiteResult& result)
                       {
                           return std::all_of(result.figures.begin(), result.figures.end(),
                                              [](const Figure& figure)
                                              { return figure.reached().value_or(true); });
                       });
}

void printTable(std::ostream& out, const Machine& machine, const std::vector<SuiteResult>& results)
{
    out << machine.processor << ", " << machine.processors << " CPUs, " << machine.memoryMiB << " MiB; "
        << machine.renderer << ", OpenGL " << machine.glVersion << "\n";
    for (const SuiteResult& result : results)
    {
        std::vector<std::vector<std::string>> rows = {{result.suite, "asked", "measured", ""}};
        for (const Figure& figure : result.figures)
        {
            rows.push_back({figure.name, asked(figure),
                            figure.measured ? withUnit(*figure.measured, figure.unit) : "-",
                            verdict(figure)});
        }
        std::size_t widths[3] = {0, 0, 0};
        for (const auto& row : rows)
        {
            for (std::size_t column = 0; column < 3; ++column)
            {
                widths[column] = std::max(widths[column], row[column].size());
            }
        }
        out << "\n";
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
            for (std::size_t column = 0; column < 3; ++column)
            {
                out << std::left << std::setw(static_cast<int>(widths[column] + 2)) << rows[i][column];
            }
            out << rows[i][3] << "\n";
            if (i == 0) continue;
            const Figure& figure = result.figures[i - 1];
            out << "    " << figure.what << "\n";
            if (!figure.remark.empty()) out << "    " << figure.remark << "\n";
        }
    }
    out << std::flush;
}

nlohmann::ordered_json toJson(const Machine& machine, const Settings& settings,
                              const std::vector<SuiteResult>& results)
{
    nlohmann::ordered_json json;
    json["program"] = "osggeofx_bench";
    json["case"] = settings.smoke ? "smoke" : settings.quick ? "quick" : "full";
    json["machine"] = {{"processor", machine.processor},
                       {"processors", machine.processors},
                       {"memoryMiB", machine.memoryMiB},
                       {"renderer", machine.renderer},
                       {"glVersion", machine.glVersion}};
    json["suites"] = nlohmann::ordered_json::array();
    for (const SuiteResult& result : results)
    {
        nlohmann::ordered_json figures = nlohmann::ordered_json::array();
        for (const Figure& figure : result.figures)
        {
            const char* const relations[] = {"none", "below", "at most", "at least"};
            nlohmann::ordered_json entry;
            entry["name"] = figure.name;
            entry["what"] = figure.what;
            entry["unit"] = figure.unit;
            entry["relation"] = relations[static_cast<int>(figure.bound)];
            entry["asked"] =
                figure.bound == Bound::None ? nlohmann::ordered_json() : nlohmann::ordered_json(figure.asked);
            entry["measured"] = figure.measured ? nlohmann::ordered_json(*figure.measured) : nullptr;
            entry["reached"] = figure.reached() ? nlohmann::ordered_json(*figure.reached()) : nullptr;
            entry["remark"] = figure.remark;
            entry["details"] = figure.details;
            figures.push_back(entry);
        }
        json["suites"].push_back({{"suite", result.suite}, {"figures", figures}});
    }
    return json;
}

} // namespace geofx::bench
