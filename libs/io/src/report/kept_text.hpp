// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "holdfast/host/text.hpp"

namespace holdfast::io {

/// Says how many steps of a plan that is gone on with are the last ones of so many; nothing of a
/// plan of its own.
inline std::string kept_words(const std::optional<std::size_t>& kept_count,
                              std::size_t step_count) {
  return kept_count ? fmt::format("  kept        the last {} of the plan, after {} new\n",
                                  host::counted(*kept_count, "step"), step_count - *kept_count)
                    : "";
}

}  // namespace holdfast::io
