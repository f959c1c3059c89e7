// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/cascade.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "holdfast/model/connected_parts.hpp"
#include "holdfast/plan/judgement.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using verdict::Verdict;

/// Modules of the whole robot, by index, ascending.
using Piece = std::vector<std::int32_t>;

/// Whether the errors of an overloaded robot's loads leave open which connections break.
bool has_doubtful_connection(const verdict::Assessment& assessment) {
  const double largest = assessment.load_ratio_max.value_or(0);
  const double error = std::max(
      {assessment.load_ratio_range.high - largest, largest - assessment.load_ratio_range.low, 0.0});
  return std::ranges::any_of(assessment.connections, [&](const auto& connection) {
    const bool is_near = std::abs(connection.load_ratio - 1) <= error;
    return is_near && error > verdict::kLoadRatioTie;
  });
}

/// A robot that breaks, piece by piece.
class Breaking {
 public:
  /// Keeps a reference to the options. All modules of the spec exist.
  Breaking(model::RobotSpec spec, const model::Robot& whole, const CascadeOptions& options)
      : spec_(std::move(spec)), whole_(whole), options_(options) {}

  base::Result<Cascade> run() {
    Piece all(whole_.modules().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = static_cast<std::int32_t>(i);
    }
    std::vector<Piece> pieces = held_parts_of(all, whole_, {});
    while (!pieces.empty() && cascade_.reasons.empty()) {
      tell(pieces);
      std::vector<Piece> next;
      for (const Piece& piece : pieces) {
        if (const auto fault = judge(piece, next)) {
          return *fault;
        }
      }
      take_round();
      pieces = std::move(next);
    }
    conclude(pieces);
    return std::move(cascade_);
  }

 private:
  void tell(const std::vector<Piece>& pieces) const {
    std::size_t count = standing_.size();
    for (const Piece& piece : pieces) {
      count += piece.size();
    }
    if (options_.progress) {
      options_.progress(count, whole_.modules().size());
    }
  }

  /// The robot of a piece, its modules in the piece's order.
  base::Result<model::Robot> robot_of(const Piece& piece) const {
    model::RobotSpec spec = spec_;
    spec.existing.clear();
    for (const std::int32_t module : piece) {
      spec.existing.push_back(whole_.modules()[at(module)].cell);
    }
    forget_absent(spec);
    return model::Robot::create(spec, options_.equilibrium.thread_count);
  }

  /// Judges a piece; what is left of it, if it breaks, comes to the `next` ones.
  std::optional<base::Error> judge(const Piece& piece, std::vector<Piece>& next) {
    const auto robot = robot_of(piece);
    if (!robot) {
      return robot.error();
    }
    solver::EquilibriumOptions options = as_checked(robot.value(), options_.equilibrium);
    options.has_rigid_figures = false;
    const verdict::Assessment assessment = assess(robot.value(), options);
    ++cascade_.check_count;
    if (assessment.verdict == Verdict::kOverload && !has_doubtful_connection(assessment)) {
      break_apart(piece, robot.value(), assessment, next);
    } else if (assessment.verdict == Verdict::kUnstable) {
      fall(piece);
    } else {
      standing_.insert(standing_.end(), piece.begin(), piece.end());
      take_doubt(robot.value(), assessment);
    }
    return std::nullopt;
  }

  void take_doubt(const model::Robot& robot, const verdict::Assessment& assessment) {
    if (assessment.verdict == Verdict::kSafe || !cascade_.reasons.empty()) {
      return;
    }
    for (const verdict::Reason& reason : assessment.reasons) {
      cascade_.reasons.push_back({reason, verdict::cells_of(robot, reason)});
    }
  }

  void fall(const Piece& piece) { fallen_.insert(fallen_.end(), piece.begin(), piece.end()); }

  void break_apart(const Piece& piece, const model::Robot& robot,
                   const verdict::Assessment& assessment, std::vector<Piece>& next) {
    for (const std::size_t index : assessment.broken) {
      const auto [a, b] = model::ends(robot, index);
      round_.broken.push_back(
          {.between = {a, b}, .load_ratio = assessment.connections[index].load_ratio});
      spec_.released.push_back({a, b});
    }
    for (Piece& part : held_parts_of(piece, robot, assessment.broken)) {
      next.push_back(std::move(part));
    }
  }

  /// The connected parts of a piece, whose robot is given, without what is broken of it; those
  /// that nothing supports fall.
  std::vector<Piece> held_parts_of(const Piece& piece, const model::Robot& robot,
                                   const std::vector<std::size_t>& broken) {
    const std::set<std::size_t> gone(broken.begin(), broken.end());
    model::ConnectedParts parts = model::connected_parts(
        robot.connections(), piece.size(),
        [&](std::size_t index, const model::Connection&) { return !gone.contains(index); });
    std::vector<Piece> held;
    for (Piece& part : parts.lists()) {
      for (std::int32_t& module : part) {
        module = piece[at(module)];
      }
      const bool is_held = std::ranges::any_of(part, [&](std::int32_t module) {
        return whole_.modules()[at(module)].support != model::Support::kNone;
      });
      if (is_held) {
        held.push_back(std::move(part));
      } else {
        fall(part);
      }
    }
    return held;
  }

  std::vector<base::Cell> cells_of(std::vector<std::int32_t> modules) const {
    std::ranges::sort(modules);
    std::vector<base::Cell> cells;
    for (const std::int32_t module : modules) {
      cells.push_back(whole_.modules()[at(module)].cell);
    }
    return cells;
  }

  void take_round() {
    round_.fallen = cells_of(std::exchange(fallen_, {}));
    if (!round_.broken.empty() || !round_.fallen.empty()) {
      cascade_.rounds.push_back(std::exchange(round_, {}));
    }
  }

  /// `left`: pieces that are not judged any more.
  void conclude(const std::vector<Piece>& left) {
    for (const Piece& piece : left) {
      standing_.insert(standing_.end(), piece.begin(), piece.end());
    }
    cascade_.standing = cells_of(standing_);
    cascade_.outcome = !cascade_.reasons.empty()   ? CascadeOutcome::kUndecided
                       : cascade_.rounds.empty()   ? CascadeOutcome::kHolds
                       : cascade_.standing.empty() ? CascadeOutcome::kFalls
                                                   : CascadeOutcome::kStands;
  }

  model::RobotSpec spec_;  ///< With what has broken released.
  const model::Robot& whole_;
  const CascadeOptions& options_;
  std::vector<std::int32_t> standing_;  ///< Modules of pieces that hold, or of which it is unknown.
  std::vector<std::int32_t> fallen_;    ///< In this round.
  CascadeRound round_;
  Cascade cascade_;
};

}  // namespace

std::size_t Cascade::broken_count() const {
  std::size_t count = 0;
  for (const CascadeRound& round : rounds) {
    count += round.broken.size();
  }
  return count;
}

std::size_t Cascade::fallen_count() const {
  std::size_t count = 0;
  for (const CascadeRound& round : rounds) {
    count += round.fallen.size();
  }
  return count;
}

base::Result<Cascade> find_cascade(const model::RobotSpec& spec, const CascadeOptions& options) {
  model::RobotSpec whole = spec;
  whole.existing.insert(whole.existing.end(), spec.planned.begin(), spec.planned.end());
  whole.planned.clear();
  const auto robot = model::Robot::create(whole, options.equilibrium.thread_count);
  if (!robot) {
    return robot.error();
  }
  return Breaking(std::move(whole), robot.value(), options).run();
}

const char* name(CascadeOutcome outcome) {
  constexpr std::array kNames = {"holds", "stands", "falls", "undecided"};
  return kNames[static_cast<std::size_t>(outcome)];
}

}  // namespace holdfast::plan
