// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/elimination.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "holdfast/base/lattice.hpp"
#include "holdfast/solver/passages.hpp"
#include "multigrid/kernels/kernels.hpp"

namespace holdfast::solver {
namespace {

using host::Team;
using model::Robot;
using model::Support;

using base::at;

/// A tree that crosses ranks more often keeps what is left of it: a wait for each crossing costs
/// more than the iterations that it saves.
constexpr std::size_t kRoundMax = 200;

constexpr std::uint8_t kNoWay = 255;

class Eliminator {
 public:
  Eliminator(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        axis_count_(at(robot.lattice().direction_count) / 2),
        own_count_(robot.own_count()),
        halo_(robot.ranks().make_halo(own_count_, robot.part().copies)),
        degree_(robot.modules().size()) {
    result_.is_gone.assign(robot.modules().size(), 0);
  }

  /// The axis of each module's passage; nothing else is done.
  std::vector<std::int8_t> passages() {
    count_connections();
    take_hanging();
    return axes_of_passage();
  }

  Elimination run() {
    count_connections();
    take_hanging();
    take_runs(axes_of_passage());
    note_axes();
    return std::move(result_);
  }

 private:
  bool is_free(std::size_t module) const {
    return robot_.modules()[module].support == Support::kNone;
  }

  void count_connections() {
    team_.share(0, degree_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        int count = 0;
        for (const std::int32_t other : robot_.connected()[i]) {
          count += other == Robot::kNoNeighbour ? 0 : 1;
        }
        degree_[i] = static_cast<std::uint8_t>(count);
        result_.is_gone[i] = robot_.modules()[i].support == Support::kFixed ? 1 : 0;
      }
    });
  }

  std::size_t next(std::size_t module, std::size_t direction) const {
    return at(robot_.connected()[module][direction]);
  }

  bool is_connected(std::size_t module, std::size_t direction) const {
    const std::int32_t other = robot_.connected()[module][direction];
    return other != Robot::kNoNeighbour && (result_.is_gone[at(other)] == 0 ||
                                            robot_.modules()[at(other)].support == Support::kFixed);
  }

  /// Eliminates leaves until none is left.
  void take_hanging() {
    result_.round_start = {0};
    for (std::size_t leaf = 0; leaf < own_count_; ++leaf) {
      take_branch(leaf);
    }
    take_hanging_on_ranks();
  }

  /// Eliminates from a leaf on, as long as its host is one then, and this rank's own.
  void take_branch(std::size_t leaf) {
    while (leaf < own_count_ && result_.is_gone[leaf] == 0 && is_free(leaf) && degree_[leaf] == 1) {
      std::size_t direction = 0;
      while (!is_connected(leaf, direction)) {
        ++direction;
      }
      leaf = hang(leaf, direction);
    }
  }

  /// Eliminates a module; returns its host, the only one that it is connected to.
  std::size_t hang(std::size_t module, std::size_t direction) {
    const std::size_t host = next(module, direction);
    result_.is_gone[module] = 1;
    result_.hanging.push_back({.module = static_cast<std::int32_t>(module),
                               .direction = static_cast<std::uint8_t>(direction)});
    --degree_[host];
    return host;
  }

  /// Trees that cross ranks: each sends the others which of its modules have gone, and in what
  /// direction their hosts are; these may then be leaves themselves. A round ends when all ranks
  /// have taken what they can.
  void take_hanging_on_ranks() {
    std::vector<std::uint8_t> way(degree_.size(), kNoWay);
    bool is_any_new = host::any(robot_.ranks(), !result_.hanging.empty());
    while (is_any_new) {
      for (std::size_t i = result_.round_start.back(); i < result_.hanging.size(); ++i) {
        way[at(result_.hanging[i].module)] = result_.hanging[i].direction;
      }
      result_.round_start.push_back(result_.hanging.size());
      halo_->update(way.data(), sizeof(std::uint8_t));
      is_any_new = host::any(robot_.ranks(), take_copies(way));
    }
  }

  /// Takes the copies that have newly gone, then what they leave as leaves. Returns whether some
  /// have hosts of this rank.
  bool take_copies(const std::vector<std::uint8_t>& way) {
    const bool is_last = result_.round_start.size() > kRoundMax;
    std::vector<std::size_t> hosts;
    for (std::size_t i = own_count_; i < way.size(); ++i) {
      if (way[i] == kNoWay || result_.is_gone[i] != 0) {
        continue;
      }
      result_.is_gone[i] = 1;
      const std::int32_t host = robot_.connected()[i][way[i]];
      if (host != Robot::kNoNeighbour && at(host) < own_count_) {
        hosts.push_back(hang(i, way[i]));
      }
    }
    for (const std::size_t host : hosts) {
      if (!is_last) {
        take_branch(host);
      }
    }
    return !hosts.empty();
  }

  /// The axis along which a module only passes forces on, or -1.
  int axis_of_passage(std::size_t module) const {
    if (result_.is_gone[module] != 0 || !is_free(module) || degree_[module] != 2) {
      return -1;
    }
    for (std::size_t axis = 0; axis < axis_count_; ++axis) {
      if (is_connected(module, 2 * axis) && is_connected(module, 2 * axis + 1)) {
        return static_cast<int>(axis);
      }
    }
    return -1;
  }

  std::vector<std::int8_t> axes_of_passage() const {
    std::vector<std::int8_t> axis(degree_.size(), -1);
    for (std::size_t i = 0; i < own_count_; ++i) {
      axis[i] = static_cast<std::int8_t>(axis_of_passage(i));
    }
    if (robot_.ranks().is_shared()) {
      halo_->update(axis.data(), sizeof(std::int8_t));
      cut_long_runs(axis);
    }
    return axis;
  }

  /// The module before or after another one in its run, if it is in the run, too.
  std::optional<std::size_t> next_in_run(std::size_t module, std::size_t side,
                                         const std::vector<std::int8_t>& axis) const {
    const std::size_t other = next(module, 2 * at(axis[module]) + side);
    return axis[other] == axis[module] ? std::optional(other) : std::nullopt;
  }

  /// How far the run of each module goes on to one side, pitches, but no more than
  /// kBeamLengthMax + 1: what is beyond a border is known when its rank has said it.
  std::vector<std::uint8_t> lengths_ahead(std::size_t side,
                                          const std::vector<std::int8_t>& axis) const {
    std::vector<std::uint8_t> length(axis.size(), 0);
    bool is_any_new = true;
    while (is_any_new) {
      is_any_new = false;
      for (std::size_t i = 0; i < own_count_; ++i) {
        const auto ahead = axis[i] < 0 ? std::optional(i) : next_in_run(i, side, axis);
        if (!ahead || *ahead >= own_count_) {
          is_any_new =
              measure_back(i, ahead ? length[*ahead] : 0, side, axis, length) || is_any_new;
        }
      }
      halo_->update(length.data(), sizeof(std::uint8_t));
      is_any_new = host::any(robot_.ranks(), is_any_new);
    }
    return length;
  }

  /// Measures from a module back along its run, as far as it is this rank's own. Returns whether
  /// anything is new.
  bool measure_back(std::size_t module, int length, std::size_t side,
                    const std::vector<std::int8_t>& axis, std::vector<std::uint8_t>& known) const {
    bool is_any_new = false;
    for (std::optional<std::size_t> i = module; i && *i < own_count_;
         i = next_in_run(*i, 1 - side, axis)) {
      length = std::min(length + 1, kBeamLengthMax + 1);
      is_any_new = is_any_new || known[*i] != length;
      known[*i] = static_cast<std::uint8_t>(length);
    }
    return is_any_new;
  }

  /// Runs too long for one beam end in the middle where it depends on the place alone: ranks see
  /// their own ends of these only.
  void cut_long_runs(std::vector<std::int8_t>& axis) const {
    if (host::all(robot_.ranks(),
                  std::ranges::all_of(axis, [](std::int8_t one) { return one < 0; }))) {
      return;
    }
    const std::vector<std::uint8_t> behind = lengths_ahead(0, axis);
    const std::vector<std::uint8_t> ahead = lengths_ahead(1, axis);
    for (std::size_t i = 0; i < own_count_; ++i) {
      if (axis[i] >= 0 && behind[i] + ahead[i] > kBeamLengthMax && is_cut(i, at(axis[i]))) {
        axis[i] = -1;
      }
    }
    halo_->update(axis.data(), sizeof(std::int8_t));
  }

  bool is_cut(std::size_t module, std::size_t axis) const {
    const base::Lattice& lattice = robot_.lattice();
    const base::Cell step = lattice.steps[2 * axis];
    const base::Cell cell = base::axial_of(lattice, robot_.modules()[module].cell);
    const std::int32_t place = step.x != 0 ? cell.x : step.y != 0 ? cell.y : cell.z;
    return place % kBeamLengthMax == 0;
  }

  /// Whether a run goes on to an end that is here. It does, but between copies that are here for
  /// another run's sake.
  bool is_whole(std::size_t from, std::size_t direction,
                const std::vector<std::int8_t>& axis) const {
    std::int32_t module = robot_.connected()[from][direction];
    while (module != Robot::kNoNeighbour && axis[at(module)] == static_cast<int>(direction / 2)) {
      module = robot_.connected()[at(module)][direction];
    }
    return module != Robot::kNoNeighbour;
  }

  void take_runs(const std::vector<std::int8_t>& axis) {
    if (std::ranges::all_of(axis, [](std::int8_t one) { return one < 0; })) {
      return;
    }
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const bool is_end = axis[i] < 0 && (result_.is_gone[i] == 0 || !is_free(i));
      for (std::size_t direction = 0; is_end && direction < 2 * axis_count_; direction += 2) {
        if (is_connected(i, direction) &&
            axis[next(i, direction)] == static_cast<int>(direction / 2) &&
            is_whole(i, direction, axis)) {
          take_run(i, direction, axis);
        }
      }
    }
    // No rank has nodes there.
    for (std::size_t i = own_count_; i < axis.size(); ++i) {
      result_.is_gone[i] = axis[i] >= 0 ? 1 : result_.is_gone[i];
    }
  }

  /// Joins an end in a direction of even index to the other end by beams of at most kBeamLengthMax.
  void take_run(std::size_t from, std::size_t direction, const std::vector<std::int8_t>& axis) {
    bool is_at_end = false;
    while (!is_at_end) {
      std::size_t to = from;
      int length = 0;
      do {
        to = next(to, direction);
        ++length;
        is_at_end = axis[to] != static_cast<int>(direction / 2);
      } while (!is_at_end && length < kBeamLengthMax);
      if (length > 1) {
        join(from, direction, length);
      }
      from = to;
    }
  }

  void join(std::size_t from, std::size_t direction, int length) {
    result_.runs.push_back({.from = static_cast<std::int32_t>(from),
                            .direction = static_cast<std::uint8_t>(direction),
                            .length = length});
    std::size_t module = from;
    for (int i = 1; i < length; ++i) {
      module = next(module, direction);
      result_.is_gone[module] = 1;
    }
  }

  void note_axes() {
    if (!robot_.ranks().is_shared() && result_.hanging.empty() && result_.runs.empty()) {
      return;
    }
    result_.run_axis.assign(degree_.size(), Elimination::kNoAxis);
    for (const Run& run : result_.runs) {
      std::size_t module = at(run.from);
      for (int i = 1; i < run.length; ++i) {
        module = next(module, run.direction);
        result_.run_axis[module] = static_cast<std::uint8_t>(run.direction / 2U);
      }
    }
  }

  const Robot& robot_;
  Team& team_;
  std::size_t axis_count_;            ///< Pairs of opposite directions.
  std::size_t own_count_;             ///< Modules that are no copies.
  std::unique_ptr<host::Halo> halo_;  ///< Of modules.
  std::vector<std::uint8_t> degree_;  ///< Connections that are left.
  Elimination result_;
};

}  // namespace

std::vector<std::int8_t> passage_axes(const Robot& robot) {
  Team team(1);
  return Eliminator(robot, team).passages();
}

Elimination eliminate(const Robot& robot, Team& team) { return Eliminator(robot, team).run(); }

}  // namespace holdfast::solver
