// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/run_judge.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "balance.hpp"
#include "bounds/energy_bound.hpp"
#include "bounds/followed_robot.hpp"
#include "bounds/section_response.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {
namespace {

/// Pieces of a run, each of which begins with a state that is solved: at least so long, and no more
/// of them than that, whatever the number of threads, so that the same states are solved.
constexpr std::size_t kPieceMin = 8;
constexpr std::size_t kPieceCountMax = 8;

/// Smaller robots are not followed: a solution from nothing costs no more there.
constexpr std::size_t kFollowedMin = 256;

/// A section's answers take about four solutions from nothing: for fewer states they are not
/// sought.
constexpr std::size_t kSectionMin = 6;

/// The most improvements of a state, each of which costs another solution that follows.
constexpr int kImprovementMax = 2;

/// The adjoint of a facet that has left so many states of a run without a bound, alone or with
/// others, is found, which takes three solutions from nothing and a sum over all modules for each
/// state that is solved; but of so many facets after a run at most.
constexpr int kDoubtMin = 32;
constexpr std::size_t kAdjointCountMax = 16;

/// What bending may move the centre of mass by where no support polygon decides.
constexpr double kNoEdge = std::numeric_limits<double>::infinity();

}  // namespace

/// Certifies states of a growing robot one after another from the last that was solved.
class RunJudge::Certifier {
 public:
  /// Begins at the state before a piece of a run.
  Certifier(const RunJudge& judge, const ElementSet& state, FollowingWorth& worth)
      : judge_(judge),
        target_(judge.target_),
        worth_(worth),
        bound_(target_, judge.nearby_, judge.adjoints_) {
    if (judge.has_polygon_) {
      balance_.emplace(target_);
      for (const Element element : state.elements()) {
        balance_->add(element);
      }
    }
  }

  /// Goes on to the next state; its judgement if it is certified. Nothing is certified behind a
  /// state that was not, until another is begun with.
  std::optional<Judgement> add(Element element, bool is_asked);

  /// Goes on from the state that it has come to, solved and safe, before so many others.
  void begin(const ElementSet& state, const verdict::Assessment& solved, std::size_t left);

  const EnergyBound& bound() const { return bound_; }

 private:
  bool is_certified(const std::optional<double>& ratio) const {
    return ratio && bound_.shift_mm() < room_mm_;
  }

  std::optional<double> followed_ratio();

  const RunJudge& judge_;
  const model::Robot& target_;
  FollowingWorth& worth_;
  std::optional<Balance> balance_;  ///< Where the polygon decides.
  double room_mm_ = kNoEdge;  ///< What bending may move the centre of mass by without a doubt.
  std::optional<SectionResponse> section_;
  EnergyBound bound_;
  bool has_bound_ = false;
  std::optional<FollowedRobot> followed_;
};

std::optional<Judgement> RunJudge::Certifier::add(Element element, bool is_asked) {
  Judgement judgement{.verdict = verdict::Verdict::kSafe, .is_bound = true};
  if (balance_) {
    const double pitch = target_.material().pitch_mm;
    balance_->add(element);
    judgement.margin_mm = balance_->margin() * pitch;
    room_mm_ = *judgement.margin_mm - Balance::kMarginDoubt * pitch;
  }
  auto ratio = has_bound_ ? bound_.add(element) : std::nullopt;
  if (target_.modules()[base::at(element)].support == model::Support::kFixed) {
    followed_.reset();
  }
  if (followed_) {
    followed_->add(element);
  }
  if (is_certified(ratio)) {
    worth_.certify(false);
  } else {
    ratio = is_asked ? followed_ratio() : std::nullopt;
  }
  if (!ratio) {
    has_bound_ = false;
    followed_.reset();
    return std::nullopt;
  }
  judgement.load_ratio_max = judgement.load_ratio_high = ratio;
  return judgement;
}

/// A bound of the load ratio by solutions that follow the robot, where they can pay.
std::optional<double> RunJudge::Certifier::followed_ratio() {
  if (!followed_ || !(room_mm_ > 0) || !worth_.can_pay()) {
    return std::nullopt;
  }
  auto known = followed_->solve();
  for (int i = 0; known && i <= kImprovementMax; ++i) {
    const auto ratio = bound_.improve(followed_->displacement(), *known);
    if (is_certified(ratio)) {
      worth_.certify(true);
      return ratio;
    }
    known = i < kImprovementMax ? followed_->improve() : std::nullopt;
  }
  worth_.end(followed_->iteration_count());
  return std::nullopt;
}

void RunJudge::Certifier::begin(const ElementSet& state, const verdict::Assessment& solved,
                                std::size_t left) {
  followed_.reset();
  section_.reset();
  has_bound_ = false;
  if (solved.verdict != verdict::Verdict::kSafe ||
      (solved.stability_rule == verdict::StabilityRule::kPolygon && !balance_)) {
    return;
  }
  const bool is_large = state.size() >= kFollowedMin;
  const auto section = is_large ? find_section(target_, state) : std::vector<std::size_t>();
  if (!section.empty() && left >= kSectionMin) {
    section_ = SectionResponse::make(judge_.spec_, target_, state, section);
  }
  has_bound_ = bound_.begin(state.elements(), solved, section_ ? &*section_ : nullptr);
  if (has_bound_ && is_large && section.empty() &&
      worth_.begin(solved.equilibrium.iteration_count)) {
    followed_.emplace(judge_.spec_, target_, state, solved);
  }
}

RunJudge::RunJudge(const model::RobotSpec& spec, const model::Robot& target, int thread_count,
                   solver::EquilibriumOptions solver)
    : spec_(spec),
      target_(target),
      thread_count_(thread_count),
      solver_(std::move(solver)),
      has_polygon_(verdict::is_on_flat_floor(target) && target.fixed_count() == 0),
      nearby_(target),
      worth_(kPieceCountMax) {
  solver_.thread_count = 1;
  solver_.has_rigid_figures = false;
}

verdict::Assessment RunJudge::assess(const ElementSet& state) const { return solve(state, 0, {}); }

verdict::Assessment RunJudge::solve(const ElementSet& state, std::size_t place,
                                    const Wish& wish) const {
  const auto part = model::Robot::create(part_of(spec_, state), 1);
  if (!part) {
    return {};
  }
  auto solved = plan::assess(part.value(), as_checked(part.value(), solver_));
  if (wish.take_solved) {
    wish.take_solved(place, part.value(), solved);
  }
  return solved;
}

/// Judges states one after another until one is not safe: those that can be certified so by what is
/// known of the last that was solved, all others solved. No bound knows what bending does.
void RunJudge::judge_piece(Piece& piece, Sense sense, FollowingWorth& worth,
                           const Wish& wish) const {
  std::optional<Certifier> certifier;
  if (sense == Sense::kGrowing && !needs_own_solution(target_)) {
    certifier.emplace(*this, piece.begin, worth);
  }
  ElementSet state = piece.begin;
  std::vector<Judgement>& judgements = piece.judgements;
  for (const Element element : piece.run) {
    if (!judgements.empty() && wish.is_late()) {
      break;
    }
    const std::size_t place = piece.first + judgements.size();
    const bool is_asked = !wish.is_asked || wish.is_asked(place);
    state = changed(std::move(state), sense, {&element, 1});
    auto certified = certifier ? certifier->add(element, is_asked) : std::nullopt;
    if (certified || !is_asked) {
      judgements.push_back(certified.value_or(Judgement{}));
      continue;
    }
    const verdict::Assessment solved = solve(state, place, wish);
    judgements.push_back(judgement_of(solved));
    if (!judgements.back().is_safe() && !wish.goes_on) {
      break;
    }
    if (certifier) {
      certifier->begin(state, solved, piece.run.size() - judgements.size());
    }
  }
  if (certifier) {
    piece.doubtful = certifier->bound().doubtful();
    piece.asked_for = certifier->bound().asked_for();
  }
}

std::vector<RunJudge::Piece> RunJudge::pieces_of(const ElementSet& state, Sense sense,
                                                 std::span<const Element> run) {
  const std::size_t length = std::max(kPieceMin, (run.size() - 1) / kPieceCountMax + 1);
  std::vector<Piece> pieces;
  for (std::size_t first = 0; first < run.size(); first += length) {
    pieces.push_back(
        {.begin = pieces.empty() ? state : changed(pieces.back().begin, sense, pieces.back().run),
         .run = run.subspan(first, std::min(length, run.size() - first)),
         .first = first});
  }
  return pieces;
}

std::vector<Judgement> RunJudge::judge(const ElementSet& state, Sense sense,
                                       std::span<const Element> run, const Wish& wish) {
  if (sense == Sense::kGrowing && !needs_own_solution(target_)) {
    grow_adjoints(state, run);
  }
  std::vector<Piece> pieces = pieces_of(state, sense, run);
  const std::size_t count = pieces.size();
  // The last pieces, whose robots are the largest, first: so threads end at about the same time.
  std::atomic<std::size_t> taken_count{0};
  host::Team team(thread_count_);
  team.each(std::min(count, base::at(team.thread_count())), [&](std::size_t) {
    for (std::size_t turn = taken_count++; turn < count; turn = taken_count++) {
      const std::size_t i = count - 1 - turn;
      judge_piece(pieces[i], sense, worth_[i], wish);
    }
  });
  std::vector<Judgement> judgements;
  ElementSet reached = state;
  for (const Piece& piece : pieces) {
    judgements.insert(judgements.end(), piece.judgements.begin(), piece.judgements.end());
    if (piece.judgements.size() < piece.run.size() ||
        (!judgements.back().is_safe() && !wish.goes_on)) {
      break;
    }
    reached = changed(std::move(reached), sense, piece.run);
  }
  if (sense == Sense::kGrowing && (!wish.goes_on || judgements.back().is_safe())) {
    renew_adjoints(reached, pieces, wish.is_late);
  }
  return judgements;
}

/// The facets whose adjoints pay after a run, those first that have left the most states without a
/// bound.
std::vector<std::size_t> RunJudge::doubtful_facets(const ElementSet& state,
                                                   std::span<const Piece> pieces) const {
  std::map<std::size_t, int> doubtful;
  for (const Piece& piece : pieces) {
    for (const auto& [facet, count] : piece.doubtful) {
      doubtful[facet] += count;
    }
  }
  std::vector<std::pair<int, std::size_t>> ranked;
  for (const auto& [facet, count] : doubtful) {
    if (count >= kDoubtMin && state.contains(target_.facets()[facet].module)) {
      ranked.emplace_back(-count, facet);
    }
  }
  std::ranges::sort(ranked);
  ranked.resize(std::min(ranked.size(), kAdjointCountMax));
  std::vector<std::size_t> facets;
  std::ranges::transform(ranked, std::back_inserter(facets),
                         [](const auto& each) { return each.second; });
  return facets;
}

/// Continues what is known of facets to all modules of a run, before it is judged.
void RunJudge::grow_adjoints(const ElementSet& state, std::span<const Element> run) {
  const std::vector<Element> elements = state.elements();
  host::Team team(thread_count_);
  team.each(adjoints_.size(), [&](std::size_t i) {
    Adjoint& adjoint = *adjoints_[i];
    if (adjoint.grow_to(elements)) {
      std::ranges::for_each(run, [&](Element element) { adjoint.grow(base::at(element)); });
    }
  });
}

/// Finds the adjoints of doubtful facets of a safe state, to which a run has led, anew where they
/// were known, and forgets those that nobody has asked for in the run. All pieces of the next run
/// know the same ones, so that threads make no difference.
void RunJudge::renew_adjoints(const ElementSet& state, std::span<const Piece> pieces,
                              const std::function<bool()>& is_late) {
  if (target_.modules().size() - state.size() < kRunLength / 2) {
    return;  // Too few states are left to come.
  }
  const std::vector<std::size_t> facets = doubtful_facets(state, pieces);
  std::erase_if(adjoints_, [&](const auto& adjoint) {
    return std::ranges::find(facets, adjoint->facet()) != facets.end() ||
           std::ranges::none_of(pieces, [&](const Piece& piece) {
             return piece.asked_for.contains(adjoint->facet());
           });
  });
  if (!facets.empty()) {
    std::ranges::move(find_adjoints(spec_, target_, state, facets, thread_count_, is_late),
                      std::back_inserter(adjoints_));
  }
}

}  // namespace holdfast::plan
