// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a SlidePlanner does where no cube can be brought into its place: it takes cubes out of the
// way.
#include <algorithm>
#include <utility>

#include "slides/slide_planner.hpp"
#include "slides/slide_potential.hpp"

namespace holdfast::plan {

using base::at;

/// Takes a cube to where none is as near to what is wanted, as a way to shapes away from this one.
bool SlidePlanner::bridge() {
  is_pushing_ = false;
  std::vector<std::size_t> loose;
  int front = kNoPotential;
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    front = std::min(front, potential_[at(cubes_[i])]);
    if (is_loose_[i] && is_stray(cubes_[i])) {
      loose.push_back(i);
    }
  }
  std::ranges::stable_sort(loose, std::ranges::greater(),
                           [&](std::size_t cube) { return potential_[at(cubes_[cube])]; });
  // What stands on something holds what goes on from there.
  for (const bool is_foot : {true, false}) {
    for (const std::size_t cube : loose) {
      const auto found = seek(cube, WastefulPath::kAny, [&](GridCell cell) {
        return potential_[at(cell)] < front && (is_support_[at(cell)] || !is_foot);
      });
      if (!found.path.empty() && make(found.path)) {
        return true;
      }
    }
  }
  return false;
}

/// The modules that come loose if a cube is lost: those of all pieces but the largest, or of all
/// without fixed modules.
std::vector<std::size_t> SlidePlanner::hanging_on(std::size_t cube) const {
  const std::size_t count = cubes_.size() + fixed_.size();
  std::vector<bool> is_known(count);
  is_known[cube] = true;
  std::vector<std::vector<std::size_t>> pieces;
  for (std::size_t root = count; root-- > 0;) {
    if (is_known[root]) {
      continue;
    }
    std::vector<std::size_t>& piece = pieces.emplace_back(1, root);
    is_known[root] = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      for (const GridCell side : grid_.sides()) {
        const std::int32_t next = module_at_[at(cell_of(piece[i]) + side)];
        if (next >= 0 && !is_known[at(next)]) {
          is_known[at(next)] = true;
          piece.push_back(at(next));
        }
      }
    }
  }
  const auto weight = [&](const std::vector<std::size_t>& piece) {
    return std::pair(piece.front() >= cubes_.size(), piece.size());
  };
  const auto stays = std::ranges::max_element(pieces, {}, weight);
  std::vector<std::size_t> hanging;
  for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
    if (piece != stays) {
      hanging.insert(hanging.end(), piece->begin(), piece->end());
    }
  }
  return hanging;
}

/// Takes away what hangs on a stray, module by module, and then the stray. Of all strays that hold
/// others the one with the fewest. Now and then any cube goes anywhere, so that nothing comes again
/// and again.
bool SlidePlanner::unlock() {
  is_pushing_ = is_strict_ = false;
  constexpr std::uint64_t kShakenShare = 3;
  if (rng_.below(kShakenShare) == 0) {
    return shake();
  }
  if (support_count_ == 1) {
    return set_foot();
  }
  std::vector<std::size_t> hanging;
  std::size_t holder = cubes_.size();
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    if (!is_stray(cubes_[i]) || is_loose_[i]) {
      continue;
    }
    std::vector<std::size_t> found = hanging_on(i);
    const bool is_held =
        std::ranges::any_of(found, [&](std::size_t module) { return module >= cubes_.size(); });
    if (!is_held && (holder == cubes_.size() || found.size() < hanging.size())) {
      hanging = std::move(found);
      holder = i;
    }
  }
  if (holder == cubes_.size()) {
    return false;
  }
  hanging.push_back(holder);
  std::vector<bool> away_from(grid_.size());
  for (const std::size_t cube : hanging) {
    away_from[at(cubes_[cube])] = true;
  }
  while (!hanging.empty() && !judge_.is_over()) {
    find_loose();
    const auto next = std::ranges::find_if(hanging, [&](std::size_t cube) {
      return is_loose_[cube] && (cube != holder || hanging.size() == 1) && park(cube, away_from);
    });
    if (next == hanging.end()) {
      return false;
    }
    hanging.erase(next);
  }
  return hanging.empty();
}

/// Takes a cube to where it holds the robot, as only one module does, which cannot go unless
/// another one holds; and then that one into its place, if it can.
bool SlidePlanner::set_foot() {
  const auto former = std::ranges::find_if(
      cubes_, [&](GridCell cube) { return is_support_[at(cube)] && is_stray(cube); });
  const auto foot = static_cast<std::size_t>(former - cubes_.begin());
  std::vector<std::size_t> loose;
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    if (is_loose_[i]) {
      loose.push_back(i);
    }
  }
  std::ranges::stable_sort(loose, std::ranges::greater(),
                           [&](std::size_t cube) { return potential_[at(cubes_[cube])]; });
  for (const bool is_nearer : {true, false}) {
    for (const std::size_t cube : loose) {
      const auto found = seek(cube, WastefulPath::kAny, [&](GridCell cell) {
        return is_support_[at(cell)] &&
               (!is_nearer || potential_[at(cell)] < potential_[at(cubes_[cube])]);
      });
      if (found.path.empty() || !make(found.path)) {
        continue;
      }
      find_loose();
      if (foot < cubes_.size() && is_loose_[foot]) {
        const auto home =
            seek(foot, WastefulPath::kAny, [&](GridCell cell) { return in_target_[at(cell)]; });
        return home.path.empty() || make(home.path);
      }
      return true;
    }
  }
  return false;
}

/// Takes a cube to the target, or else anywhere, but not beside some cells.
bool SlidePlanner::park(std::size_t cube, const std::vector<bool>& away_from) {
  for (const bool is_goal_wanted : {true, false}) {
    const WastefulPath found = seek(cube, WastefulPath::kAny, [&](GridCell cell) {
      return (in_target_[at(cell)] || !is_goal_wanted) && !away_from[at(cell)] &&
             !is_beside(cell, away_from);
    });
    if (!found.path.empty() && make(found.path)) {
      return true;
    }
  }
  return false;
}

bool SlidePlanner::is_beside(GridCell cell, const std::vector<bool>& modules) const {
  return std::ranges::any_of(grid_.sides(), [&](GridCell side) {
    return grid_.is_module(cell + side) && modules[at(cell + side)];
  });
}

/// Takes a random cube somewhere.
bool SlidePlanner::shake() {
  is_pushing_ = is_strict_ = false;
  find_loose();
  constexpr std::size_t kTries = 10;
  constexpr std::uint64_t kPlacesOnTheWay = 8;
  for (std::size_t i = 0; i < kTries * cubes_.size(); ++i) {
    const std::size_t cube = rng_.below(cubes_.size());
    if (is_loose_[cube]) {
      const auto found = seek(cube, WastefulPath::kAny,
                              [&](GridCell) { return rng_.below(kPlacesOnTheWay) == 0; });
      if (!found.path.empty() && make(found.path)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace holdfast::plan
