// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "parts/wholeness.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

/// Sets that are united pair by pair.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  std::int32_t find(std::int32_t item) {
    while (parent_[at(item)] != item) {
      parent_[at(item)] = parent_[at(parent_[at(item)])];
      item = parent_[at(item)];
    }
    return item;
  }

  void unite(std::int32_t a, std::int32_t b) { parent_[at(find(a))] = find(b); }

 private:
  std::vector<std::int32_t> parent_;
};

/// Two pieces of two ranks that are connected, numbered among all ranks' pieces.
struct Link {
  std::int32_t a = 0;
  std::int32_t b = 0;

  friend auto operator<=>(const Link&, const Link&) = default;
};

/// The piece of its own rank's part that each module belongs to, among all ranks' pieces; of copies
/// what their ranks say. Returns how many pieces all ranks have.
std::size_t number_pieces(const model::Robot& robot, std::vector<std::int32_t>& piece) {
  const model::RobotPart& part = robot.part();
  host::Ranks& ranks = part.ranks;
  Sets sets(part.own_count);
  for (const model::Connection& pair : robot.connections()) {
    if (at(pair.b) < part.own_count) {
      sets.unite(pair.a, pair.b);
    }
  }
  std::int32_t count = 0;
  piece.assign(robot.modules().size(), -1);
  for (std::size_t i = 0; i < part.own_count; ++i) {
    count += sets.find(static_cast<std::int32_t>(i)) == static_cast<std::int32_t>(i) ? 1 : 0;
  }
  const std::vector<std::size_t> first = host::starts(ranks, at(count));
  auto next = static_cast<std::int32_t>(first[at(ranks.rank())]);
  for (std::size_t i = 0; i < part.own_count; ++i) {
    if (sets.find(static_cast<std::int32_t>(i)) == static_cast<std::int32_t>(i)) {
      piece[i] = next++;
    }
  }
  for (std::size_t i = 0; i < part.own_count; ++i) {
    piece[i] = piece[at(sets.find(static_cast<std::int32_t>(i)))];
  }
  ranks.make_halo(part.own_count, part.copies)->update(piece.data(), sizeof(std::int32_t));
  return first.back();
}

/// The number of pieces that the whole robot is in.
std::size_t count_pieces(const model::Robot& robot) {
  std::vector<std::int32_t> piece;
  const std::size_t count = number_pieces(robot, piece);
  std::set<Link> links;
  for (const model::Connection& pair : robot.connections()) {
    if (piece[at(pair.a)] != piece[at(pair.b)]) {
      links.insert({.a = piece[at(pair.a)], .b = piece[at(pair.b)]});
    }
  }
  Sets sets(count);
  std::size_t left = count;
  for (const Link& link :
       host::gather<Link>(robot.ranks(), std::vector<Link>(links.begin(), links.end()))) {
    if (sets.find(link.a) != sets.find(link.b)) {
      sets.unite(link.a, link.b);
      --left;
    }
  }
  return left;
}

}  // namespace

std::optional<std::string> find_fault(const model::Robot& robot) {
  const std::size_t pieces = count_pieces(robot);
  if (pieces > 1) {
    return "the robot is in " + std::to_string(pieces) + " pieces, expected one";
  }
  if (host::all(robot.ranks(), robot.facets().empty() && robot.fixed_count() == 0)) {
    return "nothing holds the robot: no module is fixed, and none touches the ground or an "
           "obstacle";
  }
  return std::nullopt;
}

}  // namespace holdfast::cluster
