// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// Many short runs of small random robots in which one kind of thing goes wrong each, at random
/// times of the first round or after it. What every module says is compared at every moment with
/// the exact verdict of the robot as it is then (true_robot.hpp), and how soon all say the same
/// with a robot that starts from nothing as it is in the end.
namespace holdfast::test {

enum class Mishap : std::uint8_t {
  kDeathsAtOnce,  ///< Two to four modules fall silent at the same time.
  kRootDies,      ///< The root does, in each of its phases.
  kPartCutOff,    ///< All links to a part fail, and most times come back: nobody is told.
  kPartTakenOff,  ///< A part is taken off, and most times put on again.
  kReset,         ///< Modules start again with nothing remembered, also dead ones: nobody is told.
  kChangedMessages,  ///< A module's messages have changed fields, and their checksums are right.
  kChangedRenewals,  ///< The same after the verdict, while plans are told, withdrawn, carried out.
  kChanges,          ///< Plans told, withdrawn, carried out; modules taken off. Nothing fails.
  kAll,              ///< Several of these.
};
inline constexpr std::size_t kMishapCount = 9;

const char* name(Mishap what);

/// Runs by what came of them.
struct MishapTally {
  int runs = 0;
  int wrong_safe = 0;  ///< A module shows `safe` when the robot has not been for the stated time.
  int old_safe = 0;    ///< A module shows the `safe` from before a change for longer than that.
  int silent = 0;      ///< A living module says nothing in the end.
  int divided = 0;     ///< Living modules that are connected do not say the same.
  int late = 0;        ///< They come to say it after more than 3 fresh starts.
  int whole_runs = 0;  ///< Nothing is broken in the end, and no module lies.
  int wrong = 0;       ///< Of these: another verdict than the exact one, ...
  int undecided = 0;   ///< ... `undecided`, where the exact one is decided.
  long changed = 0;    ///< Messages changed on purpose.
  double slowest = 0;  ///< The last verdict behind the last fault, in fresh starts.
  double longest = 0;  ///< An old `safe` after a change, in times that a link takes to be lost.

  int faults() const { return wrong_safe + old_safe + silent + divided + late + wrong + undecided; }
};

/// One run; does nothing if the robot of this seed has no place for it.
void run_mishap(Mishap what, std::uint64_t seed, MishapTally& tally);

}  // namespace holdfast::test
