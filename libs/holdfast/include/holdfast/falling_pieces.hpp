// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "holdfast/cascade.hpp"
#include "holdfast/fall/fall.hpp"  // IWYU pragma: export

/// The facade's pictures of a fall: how what breaks off comes down. An illustration: the cascade
/// says what falls, and no verdict depends on how.
namespace holdfast {

struct FallingPieces {
  static constexpr std::int32_t kNone = -1;

  std::vector<std::int32_t> body_of;  ///< By module of the robot: its body, kNone if it stands.
  std::vector<double> round_s;        ///< When each round of the cascade begins, s.
  fall::Fall fall;
};

/// Lets the modules that fall in a cascade fall, in rigid pieces of those that are still connected,
/// one round after another. What stands and obstacles near by are in their way. `robot` is that of
/// the spec.
FallingPieces simulate_fall(const model::RobotSpec& spec, const model::Robot& robot,
                            const plan::Cascade& cascade);

/// Writes that fall as a series for ParaView: `path`, a .pvd file, and beside it a .vtu file for
/// each frame of FallingPieces::fall, without loads. `assessment` is what check() says of the
/// structure. Errors: files that cannot be written; no module falls.
[[nodiscard]] std::optional<base::Error> write_fall_series(const std::filesystem::path& path,
                                                           const Structure& structure,
                                                           const verdict::Assessment& assessment,
                                                           const plan::Cascade& cascade,
                                                           int thread_count = 0);

}  // namespace holdfast
