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

/// The connections that break in an overloaded robot. One that bends may carry less under all of
/// its loads than on the way: then it is the one that breaks there.
std::vector<std::size_t> breaking(const verdict::Assessment& assessment) {
  return assessment.broken.empty()
             ? std::vector{static_cast<std::size_t>(assessment.reasons.front().numbers[2])}
             : assessment.broken;
}

/// Whether an unstable robot falls: it topples, bent or not. One that buckles or collapses else may
/// come to rest again.
bool is_fall(const verdict::Assessment& assessment) {
  const verdict::Reason& reason = assessment.reasons.front();
  const bool bends_away = reason.code == verdict::ReasonCode::kBuckles ||
                          reason.code == verdict::ReasonCode::kCollapses;
  return !bends_away || reason.numbers[5] > 0;
}

/// A robot that breaks, piece by piece.
class Breaking {
 public:
  /// Keeps a reference to the options. All modules of the spec exist.
  Breaking(model::RobotSpec spec, const model::Robot& whole, const CascadeOptions& options)
      : spec_(std::move(spec)), whole_(whole), options_(options) {}

  /// Follows it, without the connection or module that is lost, if one is.
  base::Result<Cascade> run(const Loss* loss = nullptr) {
    Piece all(whole_.modules().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = static_cast<std::int32_t>(i);
    }
    const auto keeps_all = [](std::size_t, const model::Connection&) { return true; };
    std::vector<Piece> pieces =
        loss != nullptr ? parts_after(*loss, all) : held_parts_of(all, whole_, keeps_all);
    take_round();  // Of what falls at once.
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

  /// The parts that are held without a connection or a module; what is not, falls.
  std::vector<Piece> parts_after(const Loss& loss, const Piece& all) {
    const auto index = [&](const base::Cell& cell) {
      const auto found = std::ranges::find(whole_.modules(), cell, &model::Module::cell);
      return static_cast<std::int32_t>(found - whole_.modules().begin());
    };
    const std::int32_t a = index(loss.cells[0]);
    if (loss.kind == LossKind::kModule) {
      return parts_without(modules_of(loss, a), all);
    }
    spec_.released.push_back({loss.cells[0], loss.cells[1]});
    const auto lost = std::minmax({a, index(loss.cells[1])});
    return held_parts_of(all, whole_, [lost](std::size_t, const model::Connection& pair) {
      return std::minmax({pair.a, pair.b}) != lost;
    });
  }

  /// The modules that are lost, ascending: one, or those of a body.
  Piece modules_of(const Loss& loss, std::int32_t first) const {
    const auto bodies = whole_.modules_by_body();
    const auto found = bodies.find(loss.body);
    return found == bodies.end() ? Piece{first} : found->second;
  }

  std::vector<Piece> parts_without(const Piece& lost, const Piece& all) {
    const auto is_lost = [&](std::int32_t module) {
      return std::ranges::binary_search(lost, module);
    };
    std::vector<Piece> held =
        held_parts_of(all, whole_, [&](std::size_t, const model::Connection& pair) {
          return !is_lost(pair.a) && !is_lost(pair.b);
        });
    std::erase_if(held, [&](const Piece& piece) { return is_lost(piece.front()); });
    std::erase_if(fallen_, is_lost);
    return held;
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
    const verdict::Assessment assessment =
        options_.is_deformed ? assess_bent(robot.value(), options, spec_.obstacles)
                             : assess(robot.value(), options);
    ++cascade_.check_count;
    if (assessment.verdict == Verdict::kOverload && !has_doubtful_connection(assessment)) {
      break_apart(piece, robot.value(), assessment, next);
    } else if (assessment.verdict == Verdict::kUnstable && is_fall(assessment)) {
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
    const std::vector<std::size_t> broken = breaking(assessment);
    for (const std::size_t index : broken) {
      const auto [a, b] = model::ends(robot, index);
      round_.broken.push_back(
          {.between = {a, b}, .load_ratio = assessment.connections[index].load_ratio});
      spec_.released.push_back({a, b});
    }
    const std::set<std::size_t> gone(broken.begin(), broken.end());
    const auto is_whole = [&](std::size_t index, const model::Connection&) {
      return !gone.contains(index);
    };
    for (Piece& part : held_parts_of(piece, robot, is_whole)) {
      next.push_back(std::move(part));
    }
  }

  /// The parts of a piece, whose robot is given, that are joined by those connections of which
  /// is_whole(index, connection) is true; those that nothing supports fall.
  template <class IsWhole>
  std::vector<Piece> held_parts_of(const Piece& piece, const model::Robot& robot,
                                   const IsWhole& is_whole) {
    model::ConnectedParts parts =
        model::connected_parts(robot.connections(), piece.size(), is_whole);
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
    cells.reserve(modules.size());
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

/// Whether a facet is all that holds a robot.
bool is_last_foot(const model::Robot& robot, const Loss& loss) {
  const auto held = std::ranges::count_if(robot.modules(), [](const model::Module& module) {
    return module.support != model::Support::kNone;
  });
  return loss.direction && held == 1 && robot.facets().size() == 1;
}

/// The spec with its planned modules among those that exist.
model::RobotSpec all_existing(const model::RobotSpec& spec) {
  model::RobotSpec whole = spec;
  whole.existing.insert(whole.existing.end(), spec.planned.begin(), spec.planned.end());
  whole.planned.clear();
  return whole;
}

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
  model::RobotSpec whole = all_existing(spec);
  const auto robot = model::Robot::create(whole, options.equilibrium.thread_count);
  if (!robot) {
    return robot.error();
  }
  return Breaking(std::move(whole), robot.value(), options).run();
}

base::Result<Cascade> find_cascade_after(const model::RobotSpec& spec, const Loss& loss,
                                         const CascadeOptions& options) {
  model::RobotSpec whole = all_existing(spec);
  if (loss.kind == LossKind::kFoot) {
    const auto robot = model::Robot::create(whole, options.equilibrium.thread_count);
    if (robot && is_last_foot(robot.value(), loss)) {
      return Cascade{.outcome = CascadeOutcome::kFalls, .rounds = {{.fallen = whole.existing}}};
    }
    if (loss.direction) {
      whole.lost_facets.push_back({.cell = loss.cells[0], .direction = *loss.direction});
    } else {
      std::erase(whole.fixed, loss.cells[0]);
    }
    return find_cascade(whole, options);
  }
  const auto robot = model::Robot::create(whole, options.equilibrium.thread_count);
  if (!robot) {
    return robot.error();
  }
  return Breaking(std::move(whole), robot.value(), options).run(&loss);
}

const char* name(CascadeOutcome outcome) {
  constexpr std::array kNames = {"holds", "stands", "falls", "undecided"};
  return kNames[static_cast<std::size_t>(outcome)];
}

}  // namespace holdfast::plan
