// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/losses.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "bounds/loop_bound.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/host/interruption.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/connected_parts.hpp"
#include "holdfast/plan/part_of.hpp"
#include "judges/core_assessment.hpp"
#include "judges/loss_judge.hpp"
#include "own_solution.hpp"
#include "patches/lost_part.hpp"
#include "patches/patch_bound.hpp"
#include "patience.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Cell;
using verdict::Verdict;

/// A core serves robots of no more modules: larger ones take long to be assessed anyway.
constexpr std::size_t kLossCoreCountMax = 2000;

/// Modules by index, ascending.
using Piece = std::vector<std::int32_t>;

/// The number of losses that are judged between two looks at the clock.
constexpr std::size_t kLossStride = 256;

/// Thrown through work for which nobody waits any more.
struct LossTimeIsUp {};

/// Somebody who waits is told how far it is so often, also by work that does not end meanwhile.
constexpr std::chrono::milliseconds kTellPeriod{100};

/// The worst loss is sought among so many that are known by a bound alone.
constexpr std::size_t kRefinedMax = 256;

/// The spec without what is lost, but for a body, whose modules are in no piece that is left. All
/// modules are there: a piece may have none but planned ones.
model::RobotSpec spec_after(model::RobotSpec spec, const Loss& loss) {
  const Cell& cell = loss.cells[0];
  spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
  spec.planned.clear();
  switch (loss.kind) {
    case LossKind::kConnection:
      spec.released.push_back({loss.cells[0], loss.cells[1]});
      break;
    case LossKind::kModule:
      std::erase(spec.existing, cell);
      break;
    case LossKind::kFoot:
      if (loss.direction) {
        spec.lost_facets.push_back({.cell = cell, .direction = *loss.direction});
      } else {
        std::erase(spec.fixed, cell);
      }
      break;
  }
  return spec;
}

void forget_carried(model::RobotSpec& spec) {
  std::vector<Cell> there = spec.existing;
  std::ranges::sort(there);
  std::erase_if(spec.carried, [&](const model::CarriedMass& mass) {
    return !std::ranges::binary_search(there, mass.carrier);
  });
}

/// Judges all losses of one robot.
class LossSearch {
 public:
  LossSearch(const model::RobotSpec& spec, const model::Robot& robot, const LossOptions& options)
      : spec_(spec),
        robot_(robot),
        options_(options),
        patience_(options.seconds_max, not_interrupted_) {
    options_.equilibrium = as_checked(robot, options_.equilibrium);
    options_.equilibrium.has_rigid_figures = false;
    // What bending does takes a solution of each robot by itself.
    options_.is_by_checks =
        options_.is_by_checks || options_.is_deformed || needs_own_solution(robot);
  }

  LossReport find() {
    const verdict::Assessment solved =
        options_.is_deformed ? assess_bent(robot_, options_.equilibrium, spec_.obstacles)
                             : assess(robot_, options_.equilibrium);
    LossReport report{.whole = judgement_of(solved)};
    parts_ = PartFinder(robot_).find(options_.kinds);
    report.loss_count = parts_.size();
    if (!report.whole.is_safe()) {
      return report;
    }
    answers_.resize(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      look_at(i);
    }
    while_time_lasts([&] { judge_without_checks(solved); });
    report.bound_count = count_bounds();
    while_time_lasts([&] { check_rest(report); });
    give_up_rest();
    while_time_lasts([&] { refine(); });
    conclude(report);
    if (options_.is_cascade_wanted) {
      while_time_lasts([&] { find_aftermaths(report.fatal); });
    }
    return report;
  }

 private:
  /// Does work until it is done, or time is up: what it has found by then is whole.
  template <class Work>
  void while_time_lasts(const Work& work) {
    if (!std::isfinite(options_.seconds_max)) {
      work();
    } else if (!patience_.is_over()) {
      const host::Interruptible interruptible([this] { expect_time(); });
      try {
        work();
      } catch (const LossTimeIsUp&) {
        return;  // What is left is undecided.
      }
    }
  }

  /// Called all the time by work on the thread that waits.
  void expect_time() {
    if (patience_.is_over()) {
      throw LossTimeIsUp{};
    }
    const auto now = std::chrono::steady_clock::now();
    if (options_.progress && now - last_told_ >= kTellPeriod) {
      last_told_ = now;
      options_.progress(told_count_, answers_.size());
    }
  }

  void judge_without_checks(const verdict::Assessment& solved) {
    if (options_.is_by_checks) {
      return;
    }
    if (robot_.modules().size() >= options_.loop_count_min) {
      bound_locally(solved);
    }
    if (left_count() == 0) {
      return;
    }
    tell();
    judge_ = LossJudge::make(spec_, robot_, solved, parts_, options_.equilibrium);
    if (judge_) {
      bound_each([&](const LostPart& part) { return judge_->bound(part); });
      judge_all(left(), false);
    }
  }

  LossAnswer answer_of(std::size_t index) const { return {.loss = parts_[index].loss}; }

  /// What needs no mechanics: modules that nothing holds fall.
  void look_at(std::size_t index) {
    if (parts_[index].fallen_count > 0) {
      answers_[index] = answer_of(index);
      answers_[index]->verdict = Verdict::kUnstable;
      answers_[index]->fallen_count = parts_[index].fallen_count;
    }
  }

  std::vector<std::size_t> left() const {
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      if (!answers_[i]) {
        some.push_back(i);
      }
    }
    return some;
  }

  std::size_t left_count() const { return left().size(); }

  std::size_t count_bounds() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        answers_, [](const auto& answer) { return answer && answer->is_bound; }));
  }

  void bound_locally(const verdict::Assessment& solved) {
    const auto loops = LoopBound::make(spec_, robot_, solved, options_.equilibrium.is_bonded);
    if (!loops) {
      return;
    }
    bound_each([&](const LostPart& part) {
      return part.loss.kind == LossKind::kConnection && !part.is_apart
                 ? loops->without(part.change.lost_beams.front())
                 : std::nullopt;
    });
    tell();
    const PatchBound patches(robot_, solved, *loops, options_.equilibrium.is_bonded);
    for (const int hops : PatchBound::kHops) {
      bound_by_patches(patches, hops);
    }
  }

  /// Takes the patterns that most losses have, so many as are cheap.
  void bound_by_patches(const PatchBound& patches, int hops) {
    std::vector<std::optional<std::size_t>> patterns(parts_.size());
    host::Team team(options_.equilibrium.thread_count, parts_.size());
    team.share(0, parts_.size(), [&](std::size_t begin, std::size_t end) {
      for (; begin < end; ++begin) {
        patterns[begin] = answers_[begin] ? std::nullopt : patches.pattern(parts_[begin], hops);
      }
    });
    std::map<std::size_t, std::size_t> counts;
    for (const auto& pattern : patterns) {
      if (pattern) {
        ++counts[*pattern];
      }
    }
    std::vector<std::size_t> sizes;
    std::ranges::transform(counts, std::back_inserter(sizes),
                           [](const auto& one) { return one.second; });
    std::ranges::sort(sizes, std::ranges::greater());
    const std::size_t count_max = patches.pattern_count_max(hops);
    const std::size_t least = std::max(PatchBound::sharing_min(hops),
                                       sizes.size() > count_max ? sizes[count_max] + 1 : 0);
    bound_each([&](const LostPart& part) {
      const auto& pattern = patterns[static_cast<std::size_t>(&part - parts_.data())];
      return pattern && counts.find(*pattern)->second >= least ? patches.without(part, hops)
                                                               : std::nullopt;
    });
    tell();
  }

  /// Answers those that are safe by what bound_of(part) says.
  template <class Bound>
  void bound_each(const Bound& bound_of) {
    host::Team team(options_.equilibrium.thread_count, parts_.size());
    team.share(0, parts_.size(), [&](std::size_t begin, std::size_t end) {
      for (; begin < end; ++begin) {
        const auto bound = answers_[begin] ? std::nullopt : bound_of(parts_[begin]);
        if (bound) {
          answers_[begin] = answer_of(begin);
          answers_[begin]->verdict = Verdict::kSafe;
          answers_[begin]->load_ratio_max = bound;
          answers_[begin]->is_bound = true;
        }
      }
    });
  }

  void tell() {
    if (options_.progress) {
      told_count_ = answers_.size() - left_count();
      options_.progress(told_count_, answers_.size());
    }
  }

  /// Judges these exactly, as far as that goes without checks.
  void judge_all(const std::vector<std::size_t>& some, bool is_again) {
    std::vector<const LostPart*> asked;
    asked.reserve(some.size());
    for (const std::size_t i : some) {
      asked.push_back(&parts_[i]);
    }
    std::vector<std::optional<Judgement>> judged(asked.size());
    for (std::size_t first = 0; first < asked.size(); first += kLossStride) {
      const std::size_t count = std::min(kLossStride, asked.size() - first);
      judge_->judge(std::span(asked).subspan(first, count),
                    std::span(judged).subspan(first, count));
      for (std::size_t i = first; i < first + count; ++i) {
        if (judged[i]) {
          LossAnswer& answer = answers_[some[i]].emplace(answer_of(some[i]));
          answer.verdict = judged[i]->verdict;
          answer.load_ratio_max = judged[i]->load_ratio_max;
        }
      }
      if (!is_again) {
        tell();
      }
    }
  }

  void check_rest(LossReport& report) {
    for (const std::size_t i : left()) {
      host::ask_whether_to_go_on();
      answers_[i] = check(parts_[i]);
      ++report.check_count;
      tell();
    }
  }

  /// What nobody has judged is undecided.
  void give_up_rest() {
    for (const std::size_t i : left()) {
      answers_[i] = answer_of(i);
    }
  }

  /// Judges what is left, each piece by itself, by a check of it.
  LossAnswer check(const LostPart& part) {
    LossAnswer answer{.loss = part.loss, .verdict = Verdict::kSafe};
    const model::RobotSpec changed = spec_after(spec_, part.loss);
    const std::vector<Piece> pieces = pieces_without(part);
    for (const Piece& piece : pieces) {
      model::RobotSpec spec = changed;
      spec.existing.clear();
      for (const std::int32_t module : piece) {
        spec.existing.push_back(robot_.modules()[at(module)].cell);
      }
      forget_absent(spec);
      forget_carried(spec);
      const auto robot = model::Robot::create(spec, options_.equilibrium.thread_count);
      const Judgement judgement =
          robot ? judge_piece(robot.value(), pieces.size() == 1) : Judgement{};
      if (verdict::severity(judgement.verdict) > verdict::severity(answer.verdict)) {
        answer.verdict = judgement.verdict;
      }
      if (judgement.load_ratio_max) {
        answer.load_ratio_max = std::max(answer.load_ratio_max.value_or(*judgement.load_ratio_max),
                                         *judgement.load_ratio_max);
      }
    }
    return answer;
  }

  /// What is left of the robot, fallen pieces included.
  std::vector<Piece> pieces_without(const LostPart& part) const {
    model::ConnectedParts parts = model::connected_parts(
        robot_.connections(), robot_.modules().size(),
        [&](std::size_t, const model::Connection& pair) { return !part.lacks(pair); });
    std::vector<Piece> pieces = parts.lists();
    std::erase_if(pieces, [&](const Piece& piece) { return part.has_lost(piece.front()); });
    return pieces;
  }

  Judgement judge_piece(const model::Robot& robot, bool is_whole) {
    if (is_whole && !options_.is_by_checks) {
      if (CoreResponse* const core = core_of_robot()) {
        if (const auto assessment =
                assess_by_core(*core, robot, options_.equilibrium.thread_count)) {
          return judgement_of(*assessment);
        }
      }
    }
    if (options_.is_deformed) {
      solver::EquilibriumOptions mine = as_checked(robot, options_.equilibrium);
      return judgement_of(assess_bent(robot, mine, spec_.obstacles));
    }
    return plan::judge(robot, options_.equilibrium);
  }

  CoreResponse* core_of_robot() {
    if (!is_core_sought_ && robot_.modules().size() <= kLossCoreCountMax) {
      auto robot = model::Robot::create(spec_, options_.equilibrium.thread_count);
      HOLDFAST_CHECK(robot.has_value());
      core_ = CoreResponse::make(std::move(robot).value(), options_.equilibrium);
    }
    is_core_sought_ = true;
    return core_.get();
  }

  /// Whether an answer says how much is carried after a loss.
  static bool has_ratio(const std::optional<LossAnswer>& answer, bool is_bound) {
    return answer->load_ratio_max && answer->verdict != Verdict::kUnstable &&
           answer->is_bound == is_bound;
  }

  double largest_ratio() const {
    double largest = -std::numeric_limits<double>::infinity();
    for (const auto& answer : answers_) {
      largest = has_ratio(answer, false) ? std::max(largest, *answer->load_ratio_max) : largest;
    }
    return largest;
  }

  /// Judges those exactly whose bound is above all that is known exactly, the largest first.
  void refine() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      if (has_ratio(answers_[i], true)) {
        order.push_back(i);
      }
    }
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::size_t i) { return *answers_[i]->load_ratio_max; });
    double largest = largest_ratio();
    if (!judge_) {
      return;
    }
    const std::size_t count = std::min(order.size(), kRefinedMax);
    for (std::size_t first = 0; first < count; first += solver::kLaneCount) {
      if (*answers_[order[first]]->load_ratio_max <= largest) {
        break;
      }
      const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
      const std::size_t size = std::min(solver::kLaneCount, count - first);
      judge_all({begin, begin + static_cast<std::ptrdiff_t>(size)}, true);
      largest = std::max(largest, largest_ratio());
    }
  }

  void conclude(LossReport& report) const {
    const double largest = largest_ratio();
    for (const auto& answer : answers_) {
      report.answers.push_back(*answer);
      if (answer->is_fatal()) {
        report.fatal.push_back(*answer);
      } else if (answer->verdict != Verdict::kSafe) {
        report.undecided.push_back(*answer);
      }
      const bool counts = has_ratio(answer, false) ||
                          (has_ratio(answer, true) && *answer->load_ratio_max > largest);
      if (counts && (!report.worst || *answer->load_ratio_max > *report.worst->load_ratio_max)) {
        report.worst = *answer;
      }
    }
  }

  /// What follows each fatal loss, as long as there is time.
  void find_aftermaths(std::vector<LossAnswer>& fatal) {
    const CascadeOptions how{.equilibrium = options_.equilibrium,
                             .is_deformed = options_.is_deformed};
    for (LossAnswer& answer : fatal) {
      host::ask_whether_to_go_on();
      const auto cascade = find_cascade_after(spec_, answer.loss, how);
      if (cascade) {
        const Cascade& found = cascade.value();
        answer.after = Aftermath{.outcome = found.outcome,
                                 .round_count = found.rounds.size(),
                                 .broken_count = found.broken_count(),
                                 .fallen_count = found.fallen_count()};
      }
    }
  }

  const model::RobotSpec& spec_;
  const model::Robot& robot_;
  LossOptions options_;
  std::function<bool()> not_interrupted_ = {};
  Patience patience_;
  std::vector<LostPart> parts_;
  std::vector<std::optional<LossAnswer>> answers_;
  std::unique_ptr<LossJudge> judge_;
  std::size_t told_count_ = 0;  ///< So many were judged when somebody was told.
  std::chrono::steady_clock::time_point last_told_ = {};
  bool is_core_sought_ = false;
  std::unique_ptr<CoreResponse> core_;
};

}  // namespace

std::string_view name(LossKind kind) {
  constexpr std::array<std::string_view, kLossKindCount> kNames = {"connection", "module", "foot"};
  return kNames[static_cast<std::size_t>(kind)];
}

LossReport lose_each(const model::RobotSpec& spec, const LossOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  HOLDFAST_CHECK(robot.has_value());
  LossReport report = LossSearch(spec, robot.value(), options).find();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace holdfast::plan
