// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/holdfast.hpp"      // IWYU pragma: export
#include "holdfast/plan/cascade.hpp"  // IWYU pragma: export

/// The facade's answer to "and what comes after the break?": which connections break one after
/// another, which modules fall, what is left.
///
///     const plan::Cascade cascade = holdfast::find_cascade(structure);
///     if (cascade.outcome == plan::CascadeOutcome::kFalls) { ... cascade.rounds ... }
namespace holdfast {

/// Takes out what breaks in a structure with its planned modules attached, and judges what is left,
/// until nothing breaks or nothing stands. `progress` is called before each round with how many
/// modules still stand, and how many there are.
plan::Cascade find_cascade(
    const Structure& structure, const CheckOptions& options = {},
    const std::function<void(std::size_t standing, std::size_t count)>& progress = {});

/// Lines for the end of report_text().
std::string cascade_text(const model::Robot& robot, const plan::Cascade& cascade);

/// Writes the key "cascade" into the report's object, which is open; docs/formats.md.
void write_cascade_member(io::JsonStream& json, const plan::Cascade& cascade);

/// The picture of a check with the modules that fall as those of a robot that topples.
std::string cascade_svg(const Structure& structure, const CheckResult& result,
                        const plan::Cascade& cascade, const io::FigureOptions& figure = {});

}  // namespace holdfast
