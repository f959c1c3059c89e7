// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/module/status_report.hpp"

/// What is heard of modules as lines of JSON; docs/schemas/listen.schema.json.
namespace holdfast::instrument {

/// One entry of a module's log; `report` is what it said last.
std::string json_line(const std::string& device, double seconds, const module::LogEntry& entry,
                      const module::StatusReport& report);

/// All that a status says.
std::string json_line(const std::string& device, const module::StatusReport& report);

/// What the listener notices itself: "silent", "answers", or "forgotten" with a count of entries.
std::string json_line(const std::string& device, const char* event,
                      std::optional<int> count = std::nullopt);

}  // namespace holdfast::instrument
