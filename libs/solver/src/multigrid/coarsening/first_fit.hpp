// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/host/ranks.hpp"
#include "holdfast/host/team.hpp"

namespace holdfast::solver {

inline constexpr std::uint8_t kNoColour = 255;

/// Colours, below 64, so that neighbours have two: first fit along the Morton curve, as which a
/// robot in parts has the colours of one machine. What is coloured are a rank's own items, by their
/// order along the curve; colours lie at places, those of other ranks' copies too. Items are
///   count(), place_count(), place(item)
///   for_neighbours(item, f)    f(place), once or more for each, maybe the item itself
///   for_copies(f)              f(place, rank of its original)
///   tell(colours)              gives copies the colours of their originals
///   is_along_axes()            whether first fit mostly comes to a chessboard
///   chessboard(item)           the colour of its cell on one
///   has_two_colours()          whether that is 0 or 1
///   preferred(item)            a colour that it has if none of its neighbours does; or kNoColour
///   is_before(place, item)     whether a neighbour comes before the item, along the axes
template <class Items>
class FirstFit {
 public:
  FirstFit(const Items& items, host::Ranks& ranks, host::Team& team)
      : items_(items), ranks_(ranks), team_(team), colours_(items.place_count(), kNoColour) {}

  /// The colours by place; those of copies do not count.
  std::vector<std::uint8_t> find() {
    if (ranks_.is_shared()) {
      colour_on_ranks();
    } else if (!items_.is_along_axes() || !is_guessed()) {
      colour_own();
    }
    return std::move(colours_);
  }

 private:
  /// More rounds than that ranks do not take.
  static constexpr int kRoundMax = 8;

  /// The first that is free. A 64th colour may be shared by neighbours: the sweep is then not quite
  /// Gauss-Seidel.
  static std::uint8_t first_free(std::uint64_t taken) {
    return static_cast<std::uint8_t>(std::min(std::countr_one(taken), 63));
  }

  /// The colours of an item's neighbours for which `counts(place)`.
  template <class Counts>
  std::uint64_t taken_around(std::size_t item, const Counts& counts) const {
    std::uint64_t taken = 0;
    items_.for_neighbours(item, [&](std::size_t place) {
      if (colours_[place] != kNoColour && counts(place)) {
        taken |= std::uint64_t{1} << colours_[place];
      }
    });
    return taken;
  }

  /// Sees the items before each and, of other ranks', the copies that have colours.
  void colour_own() {
    for (std::size_t i = 0; i < items_.count(); ++i) {
      colours_[items_.place(i)] = kNoColour;
    }
    for (std::size_t i = 0; i < items_.count(); ++i) {
      const std::uint64_t taken = taken_around(i, [](std::size_t) { return true; });
      const std::uint8_t own = items_.preferred(i);
      const bool is_free = own != kNoColour && (taken >> own & 1U) == 0;
      colours_[items_.place(i)] = is_free ? own : first_free(taken);
    }
  }

  /// A chessboard on which the first item along the curve, of the first rank that has any, has the
  /// first colour.
  void guess() {
    const std::uint8_t mine = items_.count() > 0 ? items_.chessboard(0) : kNoColour;
    const auto firsts = host::gather(ranks_, std::span<const std::uint8_t>(&mine, 1));
    const auto first = std::ranges::find_if(firsts, [](auto one) { return one != kNoColour; });
    const std::uint8_t change =
        items_.has_two_colours() && first != firsts.end() ? *first : std::uint8_t{0};
    team_.share(0, items_.count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        colours_[items_.place(i)] = static_cast<std::uint8_t>(items_.chessboard(i) ^ change);
      }
    });
  }

  /// Guesses, and says whether that is what first fit along the curve comes to.
  bool is_guessed() {
    guess();
    std::atomic<bool> is_so = true;
    team_.share(0, items_.count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && is_so.load(std::memory_order_relaxed); ++i) {
        const std::uint64_t taken =
            taken_around(i, [&](std::size_t place) { return items_.is_before(place, i); });
        if (std::countr_one(taken) != colours_[items_.place(i)]) {
          is_so = false;
        }
      }
    });
    return is_so;
  }

  /// The colours of one machine: those of lower ranks, whose items come before along the curve, are
  /// guessed, then asked for until they stay. As many rounds as ranks would do; after a few
  /// neighbours of two ranks need only have two colours.
  void colour_on_ranks() {
    const std::int32_t own_rank = ranks_.rank();
    std::vector<std::uint8_t> before;
    guess();
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kRoundMax; ++round) {
      items_.tell(colours_);
      std::vector<std::uint8_t> lower;
      items_.for_copies([&](std::size_t place, std::int32_t rank) {
        colours_[place] = rank < own_rank ? colours_[place] : kNoColour;
        lower.push_back(colours_[place]);
      });
      const bool is_changed = round == 0 || lower != before;
      if (is_changed) {
        colour_own();
      }
      before = std::move(lower);
      is_any_changed = host::any(ranks_, is_changed);
    }
    if (is_any_changed) {
      part_from_other_ranks();
    }
  }

  /// Where neighbours of two ranks have one colour, the one of the higher rank takes another. Two
  /// of them may then take the same again, and after a few rounds they keep it: they are relaxed at
  /// the same time.
  void part_from_other_ranks() {
    std::vector<bool> is_lower(colours_.size(), false);
    items_.for_copies(
        [&](std::size_t place, std::int32_t rank) { is_lower[place] = rank < ranks_.rank(); });
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kRoundMax; ++round) {
      is_any_changed = false;
      items_.tell(colours_);
      for (std::size_t i = 0; i < items_.count(); ++i) {
        const std::size_t own = items_.place(i);
        bool is_shared = false;
        const std::uint64_t taken = taken_around(i, [&](std::size_t place) {
          is_shared = is_shared || (is_lower[place] && colours_[place] == colours_[own]);
          return place != own;
        });
        if (is_shared) {
          colours_[own] = first_free(taken);
          is_any_changed = true;
        }
      }
      is_any_changed = host::any(ranks_, is_any_changed);
    }
  }

  const Items& items_;
  host::Ranks& ranks_;
  host::Team& team_;
  std::vector<std::uint8_t> colours_;
};

}  // namespace holdfast::solver
