// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "commands.hpp"
#include "holdfast/reliability.hpp"

/// The options of `check` that ask how sure its answer is where strengths scatter.
namespace holdfast::cli {

struct ScatterOptions {
  std::string cv;            ///< Empty: as the structure states.
  std::string common;        ///< Empty: none.
  std::string mass;          ///< Empty: as the structure states.
  std::string distribution;  ///< Empty: as the structure states.
  double probability = 0;    ///< 0: none is asked for.

  /// Whether there must be something that scatters.
  bool is_wanted() const {
    return !cv.empty() || !common.empty() || !mass.empty() || !distribution.empty() ||
           probability > 0;
  }
};

void add_scatter_options(CLI::App& command, ScatterOptions& options);

/// The scatter that is asked for.
ScatterWish read_scatter(const ScatterOptions& options);

/// What is wrong where options ask how sure it is, and neither they nor the file say what scatters.
base::Error nothing_scatters();

/// The exit code of a robot that is safe by itself, by the probability that is asked for: it is
/// unsafe if that is not reached, and undecided if that is not certain or no probability is known.
int exit_code_of(const ScatterOptions& options,
                 const std::optional<verdict::Reliability>& reliability);

}  // namespace holdfast::cli
