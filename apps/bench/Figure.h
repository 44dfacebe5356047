// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace geofx::bench
{

enum class Bound
{
    None, ///< shown for information; nothing is asked
    Below,
    AtMost,
    AtLeast
};

/// One number that an issue asks for, beside the one measured.
struct Figure
{
    std::string name; ///< short and stable: programs find the figure by it
    std::string what; ///< what is measured, on what, for people
    std::string unit; ///< empty for a ratio
    Bound bound = Bound::None;
    double asked = 0.0;
    std::optional<double> measured = std::nullopt;
    std::string remark = {};             ///< how it came about, or why it was not measured; may be empty
    nlohmann::ordered_json details = {}; ///< the numbers behind it

    /// Nothing where nothing is asked; a figure that was not measured has not been reached.
    std::optional<bool> reached() const;
};

/// The middle one, or the mean of the two in the middle; the vector must not be empty.
double median(std::vector<double> values);

} // namespace geofx::bench
