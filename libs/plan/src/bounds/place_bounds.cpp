// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/place_bounds.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "bounds/energy_bound.hpp"
#include "bounds/followed_robot.hpp"

namespace holdfast::plan {
namespace {

/// A robot has at most so many modules more while these are tried, which takes memory; to begin
/// with others takes a look at the whole robot.
constexpr std::size_t kTogether = 8192;

/// The robot of all modules, planned ones included, with all of the cells.
model::RobotSpec with_all(const model::RobotSpec& spec, std::span<const base::Cell> cells) {
  model::RobotSpec all = spec;
  all.existing.insert(all.existing.end(), spec.planned.begin(), spec.planned.end());
  all.existing.insert(all.existing.end(), cells.begin(), cells.end());
  all.planned.clear();
  return all;
}

/// The adjoint of a facet that has left so many places without a bound, alone or with others, is
/// found, which takes three solutions from nothing; but of so many facets at most.
constexpr int kPlaceDoubtMin = 32;
constexpr std::size_t kPlaceAdjointMax = 16;

/// The most improvements of a place by solutions that follow.
constexpr int kPlaceImprovementMax = 2;

/// Tries places of one robot.
class PlaceTrial {
 public:
  /// The first modules of the target are those of the robot that was solved.
  PlaceTrial(const model::RobotSpec& spec, const model::Robot& target, std::size_t robot_count,
             const PlaceWish& wish)
      : spec_(spec), target_(target), wish_(wish), elements_(robot_count), nearby_(target) {
    std::iota(elements_.begin(), elements_.end(), Element{0});
  }

  void judge(const verdict::Assessment& solved, std::span<PlaceBound> found) {
    const auto doubtful = judge_open(solved, found);
    std::vector<std::pair<int, std::size_t>> ranked;
    for (const auto& [facet, count] : doubtful) {
      if (count >= kPlaceDoubtMin) {
        ranked.emplace_back(-count, facet);
      }
    }
    std::ranges::sort(ranked);
    ranked.resize(std::min(ranked.size(), kPlaceAdjointMax));
    if (!ranked.empty()) {
      find_adjoints_of(ranked);
      judge_open(solved, found);
    }
    if (wish_.follows && solved.verdict == verdict::Verdict::kSafe) {
      follow(solved, found);
    }
  }

 private:
  void find_adjoints_of(const std::vector<std::pair<int, std::size_t>>& ranked) {
    ElementSet core(target_.modules().size());
    std::ranges::for_each(elements_, [&](Element element) { core.insert(element); });
    std::vector<std::size_t> facets;
    std::ranges::transform(ranked, std::back_inserter(facets),
                           [](const auto& each) { return each.second; });
    adjoints_ = find_adjoints(spec_, target_, core, facets, wish_.thread_count, wish_.is_late);
    std::erase_if(adjoints_, [&](const auto& adjoint) { return !adjoint->grow_to(elements_); });
  }

  /// Tries all places without a bound of the load ratio; how often facets were in the way.
  std::map<std::size_t, int> judge_open(const verdict::Assessment& solved,
                                        std::span<PlaceBound> found) {
    EnergyBound bound(target_, nearby_, adjoints_, EnergyBound::Use::kTrying);
    if (!bound.begin(elements_, solved)) {
      return {};
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i].is_decided() && !wish_.is_late()) {
        found[i] = try_place(bound, elements_.size() + i);
      }
    }
    return bound.doubtful();
  }

  /// Tries what is left by displacements that follow the robot with each place.
  void follow(const verdict::Assessment& solved, std::span<PlaceBound> found) {
    ElementSet core(target_.modules().size());
    std::ranges::for_each(elements_, [&](Element element) { core.insert(element); });
    EnergyBound bound(target_, nearby_, adjoints_, EnergyBound::Use::kTrying);
    FollowedRobot followed(spec_, target_, core, solved);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i].is_decided() && !wish_.is_late() && bound.begin(elements_, solved)) {
        found[i] = follow_place(bound, followed, elements_.size() + i, found[i]);
        followed.take_back(solved);
      }
    }
  }

  PlaceBound follow_place(EnergyBound& bound, FollowedRobot& followed, std::size_t module,
                          PlaceBound found) {
    std::ranges::for_each(adjoints_, [&](const auto& adjoint) { adjoint->grow(module); });
    bound.add(static_cast<Element>(module));
    followed.add(static_cast<Element>(module));
    auto known = followed.solve();
    for (int k = 0; known && !found.high && k <= kPlaceImprovementMax; ++k) {
      found.high = bound.improve(followed.displacement(), *known);
      found.shift_mm = bound.shift_mm();
      known = k < kPlaceImprovementMax && !found.high ? followed.improve() : std::nullopt;
    }
    std::ranges::for_each(adjoints_, [](const auto& adjoint) { adjoint->shrink(); });
    return found;
  }

  PlaceBound try_place(EnergyBound& bound, std::size_t module) {
    std::ranges::for_each(adjoints_, [&](const auto& adjoint) { adjoint->grow(module); });
    PlaceBound found{.high = bound.add(static_cast<Element>(module))};
    found.low = bound.ratio_low();
    found.shift_mm = bound.shift_mm();
    bound.take_back();
    std::ranges::for_each(adjoints_, [](const auto& adjoint) { adjoint->shrink(); });
    return found;
  }

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  const PlaceWish& wish_;
  std::vector<Element> elements_;
  LocalAdjoints nearby_;
  Adjoints adjoints_;
};

}  // namespace

std::vector<PlaceBound> bound_places(const model::RobotSpec& spec,
                                     const verdict::Assessment& solved,
                                     std::span<const base::Cell> cells, const PlaceWish& wish) {
  std::vector<PlaceBound> found(cells.size());
  for (std::size_t first = 0; first < cells.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, cells.size() - first);
    const auto all = with_all(spec, cells.subspan(first, count));
    const auto target = model::Robot::create(all, wish.thread_count);
    if (target) {
      PlaceTrial(all, target.value(), all.existing.size() - count, wish)
          .judge(solved, std::span(found).subspan(first, count));
    }
  }
  return found;
}

}  // namespace holdfast::plan
