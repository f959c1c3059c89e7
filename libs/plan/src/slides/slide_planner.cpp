// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/slide_planner.hpp"

#include <algorithm>
#include <utility>

#include "cut_vertices.hpp"
#include "slides/slide_potential.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using What = SlideGrid::What;

/// The most cubes that are asked anew for their best path before one is taken. More find no shorter
/// plans.
constexpr int kAskedMax = 16;

/// The potential is made anew when this share of the cubes that are left has gone, and some. Twice
/// as often finds plans of the same length.
constexpr std::size_t kRenewedShare = 6;
constexpr std::size_t kRenewedMin = 20;

/// The most unsafe moves that are barred before a shape is given up.
constexpr std::size_t kBarredMax = 400;

}  // namespace

SlidePlanner::SlidePlanner(const SlideTask& task, std::uint64_t seed, SlideJudge& judge)
    : grid_(task.grid),
      fixed_(task.fixed),
      cubes_(task.start),
      target_(task.target),
      is_support_(task.is_support),
      in_target_(task.grid.size()),
      judge_(judge),
      rng_(seed),
      search_(task.grid.size()),
      module_at_(task.grid.size(), -1),
      is_loose_(task.start.size()),
      offers_(task.start.size()),
      first_side_(task.first_side) {
  for (const GridCell cell : target_) {
    in_target_[at(cell)] = true;
  }
  for (std::size_t i = 0; i < cubes_.size() + fixed_.size(); ++i) {
    grid_.set(cell_of(i), What::kModule);
    module_at_[at(cell_of(i))] = static_cast<std::int32_t>(i);
  }
}

std::size_t SlidePlanner::count_strays() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(cubes_, [&](GridCell cube) { return is_stray(cube); }));
}

void SlidePlanner::renew_potential() {
  std::vector<GridCell> modules;
  std::vector<GridCell> goals;
  std::ranges::copy_if(cubes_, std::back_inserter(modules),
                       [&](GridCell cube) { return is_stray(cube); });
  std::ranges::copy_if(target_, std::back_inserter(goals),
                       [&](GridCell goal) { return grid_.is_free(goal); });
  potential_ = slide_potential(grid_, modules, goals);
  std::ranges::fill(offers_, Offer());
  renewed_ = 0;
}

void SlidePlanner::find_loose() {
  const std::size_t count = cubes_.size() + fixed_.size();
  const std::vector<bool> is_cut =
      cut_vertices(count, static_cast<std::int32_t>(count) - 1, SlideGrid::kSideCount,
                   [&](std::int32_t module, std::size_t side) {
                     return module_at_[at(cell_of(at(module)) + grid_.sides()[side])];
                   });
  support_count_ = 0;
  for (std::size_t i = 0; i < count; ++i) {
    support_count_ += is_support_[at(cell_of(i))] ? 1 : 0;
  }
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    is_loose_[i] = !is_cut[i] && (support_count_ > 1 || !is_support_[at(cubes_[i])]);
  }
}

bool SlidePlanner::is_loose_at(GridCell cell) const {
  const std::size_t module = at(module_at_[at(cell)]);
  return module < cubes_.size() && is_loose_[module];
}

bool SlidePlanner::run(std::size_t unlocks_left) {
  std::size_t left = count_strays();
  while (left > 0 && !judge_.is_over()) {
    if (potential_.empty() || (renewed_ > kRenewedMin && renewed_ * kRenewedShare > left)) {
      renew_potential();
    }
    find_loose();
    if (!advance() && (unlocks_left-- == 0 || !(unlock() || shake()))) {
      return false;
    }
    left = count_strays();
  }
  return left == 0;
}

/// Brings one more cube into its place, or nearer.
bool SlidePlanner::advance() {
  for (const bool is_pushing : {true, false}) {
    for (const bool is_strict : {true, false}) {
      is_pushing_ = is_pushing;
      is_strict_ = is_strict;
      while (!judge_.is_over() && barred_.size() < kBarredMax) {
        const std::size_t barred = barred_.size();
        const SlidePath path = choose();
        if (!path.empty() && make(path)) {
          return true;
        }
        if (path.empty() || barred_.size() == barred) {
          break;
        }
      }
      std::ranges::fill(offers_, Offer());
    }
  }
  return bridge();
}

/// How far a cell is in the direction of those that go first.
int SlidePlanner::height_of(GridCell cell) const {
  const base::Cell place = grid_.cell(cell);
  const std::size_t axis = first_side_ / 2;
  const int along = axis == 0 ? place.x : axis == 1 ? place.y : place.z;
  return first_side_ % 2 == 0 ? along : -along;
}

/// The stray that may have the least waste and is not asked yet, of those equal the highest first.
std::optional<std::size_t> SlidePlanner::next_to_ask() const {
  const auto rank = [&](std::size_t cube) {
    return std::tuple(offers_[cube].best.waste, -height_of(cubes_[cube]),
                      -potential_[at(cubes_[cube])]);
  };
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    if (is_loose_[i] && is_stray(cubes_[i]) && offers_[i].version != version_ &&
        (!next || rank(i) < rank(*next))) {
      next = i;
    }
  }
  return next;
}

/// The path of least waste among those of the cubes asked; empty if none leads to the target.
SlidePath SlidePlanner::choose() {
  WastefulPath best = {};
  for (int asked = 0; best.path.empty() || asked < kAskedMax; ++asked) {
    const auto next = next_to_ask();
    if (!next || (!best.path.empty() && offers_[*next].best.waste >= best.waste)) {
      break;
    }
    offers_[*next] = {
        .best = seek(*next, best.waste,
                     [&](GridCell cell) { return in_target_[at(cell)] && may_fill(cell); }),
        .version = version_};
    if (!offers_[*next].best.path.empty()) {
      best = offers_[*next].best;
    }
  }
  return best.path;
}

/// The path of one cube to a cell that is accepted.
WastefulPath SlidePlanner::seek(std::size_t cube, int waste_max,
                                const std::function<bool(GridCell)>& accepts) {
  const GridCell start = cubes_[cube];
  grid_.set(start, What::kFree);
  WastefulPath found = search_.seek(
      grid_, potential_, start, waste_max, accepts,
      [&](GridCell from, GridCell to) {
        return barred_.empty() || !barred_.contains({cube, from, to});
      },
      [&](GridCell cell) { return is_pushing_ && is_loose_at(cell); });
  grid_.set(start, What::kModule);
  return found;
}

/// Whether a cube in a cell leaves a way to all other free cells of the target, and to the cubes
/// that have to leave.
bool SlidePlanner::may_fill(GridCell goal) const {
  const auto is_shut_in = [&](GridCell side) {
    const GridCell cube = goal + side;
    return grid_.is_module(cube) && is_stray(cube) &&
           std::ranges::none_of(grid_.sides(), [&](GridCell step) {
             return cube + step != goal && grid_.is_free(cube + step);
           });
  };
  const auto is_lost = [&](GridCell side) {
    return grid_.is_free(goal + side) && has_lost_goal(goal + side, goal);
  };
  return !is_strict_ ||
         (std::ranges::none_of(grid_.sides(), is_shut_in) &&
          (!grid_.may_part_air(goal) || std::ranges::none_of(grid_.sides(), is_lost)));
}

/// Whether a free cell is in a cavity with cells of the target once another one is filled. What is
/// larger than all cubes is none.
bool SlidePlanner::has_lost_goal(GridCell air, GridCell filled) const {
  std::set<GridCell> known = {air, filled};
  std::vector<GridCell> cavity = {air};
  bool has_goal = in_target_[at(air)];
  for (std::size_t i = 0; i < cavity.size() && cavity.size() <= cubes_.size(); ++i) {
    for (const GridCell side : grid_.sides()) {
      const GridCell next = cavity[i] + side;
      if (grid_.is_free(next) && known.insert(next).second) {
        has_goal = has_goal || in_target_[at(next)];
        cavity.push_back(next);
      }
    }
  }
  return has_goal && cavity.size() <= cubes_.size();
}

/// Makes the walks of a path, the last one first; all of them, or none.
bool SlidePlanner::make(const SlidePath& path) {
  const std::size_t before = walks_.size();
  auto end = path.end();
  for (auto begin = path.end() - 1; begin != path.begin();) {
    --begin;
    if (!grid_.is_module(*begin)) {
      continue;
    }
    if (end != path.end()) {
      find_loose();
    }
    if (!step(SlideWalk(begin, end))) {
      while (walks_.size() > before) {
        relocate(walks_.back().back(), walks_.back().front());
        judge_.take_back();
        walks_.pop_back();
      }
      find_loose();
      return false;
    }
    end = begin + 1;
  }
  ++version_;
  renewed_ += 1;
  barred_.clear();
  return true;
}

/// Makes one walk if it can be made.
bool SlidePlanner::step(SlideWalk walk) {
  if (!is_loose_at(walk.front())) {
    return false;
  }
  const std::size_t cube = at(module_at_[at(walk.front())]);
  grid_.set(walk.front(), What::kFree);
  bool is_way = true;
  for (std::size_t i = 1; i < walk.size() && is_way; ++i) {
    is_way = false;
    grid_.for_each_move(walk[i - 1], [&](GridCell to) { is_way = is_way || to == walk[i]; });
  }
  grid_.set(walk.front(), What::kModule);
  if (!is_way) {
    return false;
  }
  if (const auto unsafe = judge_.find_unsafe(walk)) {
    barred_.insert({cube, walk[*unsafe], walk[*unsafe + 1]});
    offers_[cube] = {};
    return false;
  }
  relocate(walk.front(), walk.back());
  judge_.make();
  walks_.push_back(std::move(walk));
  return true;
}

void SlidePlanner::relocate(GridCell from, GridCell to) {
  const std::size_t cube = at(module_at_[at(from)]);
  grid_.set(from, What::kFree);
  grid_.set(to, What::kModule);
  std::swap(module_at_[at(from)], module_at_[at(to)]);
  cubes_[cube] = to;
  offers_[cube] = {};
}

}  // namespace holdfast::plan
