// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/groups/more_planned.hpp"
#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/agent/links/exchange.hpp"
#include "holdfast/agent/tree/spanning_tree.hpp"

namespace holdfast::agent {

/// What part planned modules that touch several others have in an exchange.
enum class PlannedPart : std::uint8_t {
  kTogether,   ///< They share their vectors like all others.
  kApart,      ///< None: their host is too far away to wait for.
  kCondensed,  ///< Their displacements, which their hosts find meanwhile (condensed.hpp).
};

/// The planned modules' part in an exchange: vectors of their hosts go down to all that touch them,
/// forces on them come up to their hosts.
class PlannedExchange {
 public:
  /// A round begins.
  void enter();

  /// An exchange begins: forces are added up anew.
  void clear_forces(MorePlanned* more) {
    force_ = {};
    if (more != nullptr) {
      more->force = {};
    }
  }

  /// The vector of a planned module that is emulated here goes to all below that touch it.
  void share(Links& links, Faces children, const Planned& planned, int index,
             const base::Vec6<float>& vector);

  /// A vector from a host above has come; it goes on.
  void take_down(Links& links, Faces children, const Planned& planned,
                 std::span<const std::uint8_t> message);

  /// Hands a vector on to children that need those of planned module `label` & kPlannedIndexMask.
  static void send_down(Links& links, Faces children, const Planned& planned, std::uint8_t label,
                        const base::Vec6<float>& vector);

  /// The vector of a planned module in the exchange under way.
  const base::Vec6<float>& vector(const Planned& planned, int index) const {
    return is_own(index) ? vector_[at(index)] : planned.more_planned()->vector[more_at(index)];
  }

  /// The force of all beams from here down on a planned module.
  const base::Vec6<double>& force(const Planned& planned, int index) const {
    return is_own(index) ? force_[at(index)] : planned.more_planned()->force[more_at(index)];
  }

  base::Vec6<double>& force(const Planned& planned, int index) {
    return is_own(index) ? force_[at(index)] : planned.more_planned()->force[more_at(index)];
  }

  void add_force(const Planned& planned, int index, const base::Vec6<double>& addend) {
    base::add_to(force(planned, index), addend);
  }

  /// Forces on planned modules from here down go to their hosts above. Where digits beyond single
  /// precision count what it leaves over follows in a second message.
  void send_up(Links& links, Faces parent, const Planned& planned, bool is_precise);

  /// A force from below has come. True: it was the last that await_forces() was told of.
  bool take_up(const Planned& planned, std::span<const std::uint8_t> message);

  /// The number of forces from below that have to come before planned modules can be condensed.
  void await_forces(int count) { forces_awaited_ = static_cast<Count>(count); }

  bool awaits_forces() const { return forces_awaited_ != 0; }

  /// Has all come that hosts above send?
  bool is_complete(const Planned& planned) const { return here_.has_all(planned.from_above()); }

  /// What planned module `index` had to send has come.
  void note_here(int index) { here_.add(index); }

  /// What hosts have sent has been used.
  void end() { here_ = {}; }

 private:
  /// Two messages a planned module and child.
  using Count = std::conditional_t<kIsGeneral, std::uint16_t, std::uint8_t>;

  static bool is_own(int index) { return !kIsGeneral || index < kPlannedMax; }

  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  static std::size_t more_at(int index) { return static_cast<std::size_t>(index - kPlannedMax); }

  PlannedSet here_;  ///< Whose vectors have come from above.
  Count forces_awaited_ = 0;
  std::array<base::Vec6<float>, kPlannedMax> vector_{};
  std::array<base::Vec6<double>, kPlannedMax> force_{};
};

}  // namespace holdfast::agent
