// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Much at once: modules die (the root among them), links fail, modules are taken off and come back
/// with their memory lost, plans are told, withdrawn and carried out, all at random times of the
/// first round and of what follows it.
namespace holdfast::test {

/// Runs by what came of them.
struct StormTally {
  int runs = 0;
  int whole_runs = 0;  ///< Nothing is broken in the end.
  int wrong_safe = 0;  ///< Some living module says `safe` of a robot that is not.
  int wrong = 0;       ///< Of those with nothing broken: another verdict than the exact one, ...
  int undecided = 0;   ///< ... `undecided`, where the exact one is decided.
  int silent = 0;      ///< Some living module says nothing.
  int divided = 0;     ///< Nothing is broken, and not all say the same.
  double latest = 0;   ///< The last verdict behind the last event, in fresh starts, where whole.

  int faults() const { return wrong_safe + wrong + silent + divided; }
};

/// A random robot of this seed.
void run_storm(std::uint64_t seed, StormTally& tally);

}  // namespace holdfast::test
