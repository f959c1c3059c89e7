// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "holdfast/holdfast.hpp"  // IWYU pragma: export

namespace holdfast {

/// The equilibria of a structure in its deformed shape as a series for ParaView: a .pvd file, and a
/// .vtu file beside it for each of those that differ by a hundredth of the loads or a quarter of
/// the pitch. Each is written as it is found; its verdict is that of the equilibrium alone.
///
///     DeformedSeries series("path.pvd", structure, options);
///     options.on_deformed_state = series.writer();
///     check(structure, options);
///     if (const auto error = series.finish()) { ... }
class DeformedSeries {
 public:
  /// Keeps a reference to the structure.
  DeformedSeries(std::filesystem::path path, const Structure& structure,
                 const CheckOptions& options);
  ~DeformedSeries();
  DeformedSeries(const DeformedSeries&) = delete;
  DeformedSeries& operator=(const DeformedSeries&) = delete;

  /// The function for CheckOptions, which must not be called after the end of this object.
  std::function<void(const large::State& state, bool is_stable, int branch)> writer();

  /// Writes the .pvd file. Errors: of this or of a .vtu file before; nothing was found.
  std::optional<base::Error> finish();

 private:
  class Body;
  std::unique_ptr<Body> body_;
};

}  // namespace holdfast
