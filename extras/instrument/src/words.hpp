// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"
#include "holdfast/module/status_report.hpp"

/// What modules report, in the words of `simulate --story`.
namespace holdfast::instrument {

/// A face of a cube, +x to -z.
const char* face_name(std::uint8_t face);

/// Faces by bit: "+x, -z", or "none".
std::string face_names(std::uint8_t faces);

/// Where a module sits, if it knows that.
std::optional<base::Cell> cell_of(const module::StatusReport& report);

/// A cell, or "(?)" of a module that has none.
std::string cell_text(const module::StatusReport& report);

/// What the module has come to.
agent::Answer answer_of(const module::StatusReport& report);

std::string phase_name(std::uint8_t phase);

/// A verdict and its reason by number; undecided for want of a reason if a later program has them.
agent::Answer known_answer(std::uint8_t verdict, std::uint16_t reason);

/// One entry of a log; `report` is what the module said last.
std::string describe(const module::LogEntry& entry, const module::StatusReport& report);

/// All that a status says, line by line.
std::vector<std::string> describe(const std::string& device, const module::StatusReport& report);

}  // namespace holdfast::instrument
