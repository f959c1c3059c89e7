// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "pieces/pieces.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace holdfast::verdict {
namespace {

/// A piece, what was found of it, and where its connections and facets are in the whole.
struct JudgedPiece {
  const model::RobotPiece* piece;
  Assessment found;
  std::vector<std::size_t> connections;
  std::vector<std::size_t> facets;
};

/// Finds the places of a robot's connections and facets by their modules.
class Places {
 public:
  explicit Places(const model::Robot& robot) : robot_(robot) {
    for (std::size_t i = 0; i < robot.connections().size(); ++i) {
      const model::Connection pair = robot.connections()[i];
      connections_.emplace_back(pair.a, pair.b, i);
    }
    std::ranges::sort(connections_);
  }

  std::size_t of_connection(std::int32_t a, std::int32_t b) const {
    return std::get<2>(*std::ranges::lower_bound(connections_, Place{a, b, 0}));
  }

  std::size_t of_facet(std::int32_t module, base::Direction direction) const {
    const auto facets = robot_.facets();
    const auto found = std::find_if(
        std::ranges::lower_bound(facets, module, {}, &model::Facet::module), facets.end(),
        [&](const model::Facet& facet) { return facet.direction == direction; });
    return static_cast<std::size_t>(found - facets.begin());
  }

 private:
  using Place = std::tuple<std::int32_t, std::int32_t, std::size_t>;

  const model::Robot& robot_;
  std::vector<Place> connections_;
};

JudgedPiece judged(const model::RobotPiece& piece, const Places& places,
                   const solver::EquilibriumOptions& options) {
  JudgedPiece one{
      .piece = &piece, .found = assess(piece.robot, options), .connections = {}, .facets = {}};
  const auto whole = [&](std::int32_t module) { return piece.modules[base::at(module)]; };
  for (const model::Connection& pair : piece.robot.connections()) {
    one.connections.push_back(places.of_connection(whole(pair.a), whole(pair.b)));
  }
  for (const model::Facet& facet : piece.robot.facets()) {
    one.facets.push_back(places.of_facet(whole(facet.module), facet.direction));
  }
  return one;
}

/// Whether a piece is worse than another, to be named before it.
bool is_worse(const JudgedPiece& a, const JudgedPiece& b) {
  const auto rank = [](const JudgedPiece& one) {
    return std::pair(severity(one.found.verdict),
                     one.found.load_ratio_max.value_or(-std::numeric_limits<double>::infinity()));
  };
  return rank(a) > rank(b);
}

PieceAnswer answer_of(const JudgedPiece& one) {
  return {.module_count = one.piece->modules.size(),
          .first = one.piece->robot.modules().front().cell,
          .verdict = one.found.verdict,
          .load_ratio_max = one.found.load_ratio_max,
          .margin_mm = one.found.simplified.margin_mm};
}

/// Puts what is known by module, connection or facet in its place in the whole.
template <class Value>
void scatter(const std::vector<Value>& from, std::span<const std::size_t> places,
             std::vector<Value>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    to[places[i]] = from[i];
  }
}

/// The loads of all pieces; none of any where they are not known of one.
void join_connections(const model::Robot& robot, const std::vector<JudgedPiece>& pieces,
                      Assessment& whole) {
  whole.connections.clear();
  whole.broken.clear();
  whole.load_ratio_max.reset();
  whole.worst.reset();
  whole.weight_factor.reset();
  whole.gaps_mm.clear();
  const bool is_known = std::ranges::all_of(pieces, [](const JudgedPiece& one) {
    return one.connections.size() == one.found.connections.size() &&
           (one.connections.empty() || one.found.load_ratio_max);
  });
  if (!is_known) {
    return;
  }
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  whole.connections.resize(robot.connections().size());
  whole.load_ratio_range = {.low = kNone, .high = kNone};
  whole.load_ratio_change = 0;
  double worst = kNone;
  for (const JudgedPiece& one : pieces) {
    const Assessment& found = one.found;
    if (one.connections.empty()) {
      continue;
    }
    scatter(found.connections, one.connections, whole.connections);
    for (const std::size_t i : found.broken) {
      whole.broken.push_back(one.connections[i]);
    }
    whole.load_ratio_max = std::max(whole.load_ratio_max.value_or(kNone), *found.load_ratio_max);
    whole.load_ratio_range.low = std::max(whole.load_ratio_range.low, found.load_ratio_range.low);
    whole.load_ratio_range.high =
        std::max(whole.load_ratio_range.high, found.load_ratio_range.high);
    whole.load_ratio_change = std::max(whole.load_ratio_change, found.load_ratio_change);
    if (*found.load_ratio_max > worst) {
      worst = *found.load_ratio_max;
      whole.worst = found.worst ? std::optional(one.connections[*found.worst]) : std::nullopt;
      whole.weight_factor = found.weight_factor;
    }
  }
  std::ranges::stable_sort(whole.broken, std::greater<>(),
                           [&](std::size_t i) { return whole.connections[i].load_ratio; });
}

void join_gaps(const std::vector<JudgedPiece>& pieces, Assessment& whole) {
  whole.gaps.reset();
  for (const JudgedPiece& one : pieces) {
    if (!one.found.gaps) {
      continue;
    }
    OpenGaps gaps = *one.found.gaps;
    gaps.worst = one.connections[gaps.worst];
    const std::size_t count = (whole.gaps ? whole.gaps->count : 0) + gaps.count;
    if (!whole.gaps || gaps.gap_mm / gaps.limit_mm > whole.gaps->gap_mm / whole.gaps->limit_mm) {
      whole.gaps = gaps;
    }
    whole.gaps->count = count;
  }
}

/// Displacements, contact states and forces of all; none of any where they are not known of one.
void join_equilibrium(const model::Robot& robot, const std::vector<JudgedPiece>& pieces,
                      solver::Equilibrium& whole) {
  const bool is_known = std::ranges::all_of(pieces, [](const JudgedPiece& one) {
    return one.found.equilibrium.displacement.size() == one.piece->modules.size() &&
           one.found.equilibrium.facet_force.size() == one.facets.size();
  });
  const bool is_any_slipping = std::ranges::any_of(
      pieces, [](const JudgedPiece& one) { return !one.found.equilibrium.slip.empty(); });
  solver::Equilibrium joined;
  joined.outcome = whole.outcome;
  joined.law = whole.law;
  joined.attempts = std::move(whole.attempts);
  joined.method = whole.method;
  joined.precision = whole.precision;
  whole = std::move(joined);
  if (is_known) {
    whole.displacement.resize(robot.modules().size());
    whole.contact.resize(robot.facets().size());
    whole.facet_force.resize(robot.facets().size());
    whole.slip.resize(is_any_slipping ? robot.facets().size() : 0);
  }
  for (const JudgedPiece& one : pieces) {
    const solver::Equilibrium& found = one.found.equilibrium;
    whole.steps += found.steps;
    whole.iteration_count += found.iteration_count;
    whole.made_column_count += found.made_column_count;
    whole.energy_error = std::max(whole.energy_error, found.energy_error);
    whole.open_but_held_count += found.open_but_held_count;
    if (is_known) {
      for (std::size_t i = 0; i < found.displacement.size(); ++i) {
        whole.displacement[base::at(one.piece->modules[i])] = found.displacement[i];
      }
      scatter(found.contact, one.facets, whole.contact);
      scatter(found.facet_force, one.facets, whole.facet_force);
      scatter(found.slip, one.facets, whole.slip);
    }
  }
}

/// Takes the stability of the piece that stands least, and what linear theory leaves out of the one
/// where it is trusted least.
void join_stability(const std::vector<JudgedPiece>& pieces, Assessment& whole) {
  const auto standing = [](const JudgedPiece& one) {
    return std::pair(one.found.is_stable, one.found.simplified.margin_mm.value_or(
                                              std::numeric_limits<double>::infinity()));
  };
  const Assessment& least = std::ranges::min_element(pieces, {}, standing)->found;
  whole.stability_rule = least.stability_rule;
  whole.simplified = least.simplified;
  whole.rigid = least.rigid;
  whole.model = least.model;
  whole.is_stable = least.is_stable;
  whole.lean = least.lean;
  const auto trust = [](const JudgedPiece& one) {
    const auto& second = one.found.second_order;
    constexpr std::array kTrust = {2, 0, 1};  // Trusted, not trusted, not certain.
    return second ? std::pair(kTrust[static_cast<std::size_t>(second->trust)], second->factor)
                  : std::pair(3, 0.0);
  };
  whole.second_order = std::ranges::min_element(pieces, {}, trust)->found.second_order;
  for (const JudgedPiece& one : pieces) {
    whole.contact_model = std::max(whole.contact_model, one.found.contact_model);
    whole.several = whole.several ? whole.several : one.found.several;
  }
}

/// The reasons of the worst piece, then of others what these do not say; each code once.
void join_reasons(const std::vector<JudgedPiece>& pieces, Assessment& whole) {
  whole.reasons.clear();
  for (const JudgedPiece& one : pieces) {
    for (std::size_t i = 0; i < one.found.reasons.size(); ++i) {
      const ReasonCode code = one.found.reasons[i].code;
      const bool is_said = std::ranges::any_of(
          whole.reasons, [&](const Reason& known) { return known.code == code; });
      if (!is_said && (i > 0 || &one == &pieces.front())) {
        whole.reasons.push_back(
            in_whole(one.found.reasons[i], one.piece->modules, one.connections));
      }
    }
    if (&one == &pieces.front()) {
      whole.reasons.push_back(
          {.code = ReasonCode::kInPieces, .numbers = {static_cast<double>(pieces.size())}});
    }
  }
  Reason& first = whole.reasons.front();
  if (first.code == ReasonCode::kConnectionsBreak) {
    first.numbers[0] = static_cast<double>(whole.broken.size());
    first.numbers[1] = static_cast<double>(whole.connections.size());
  }
}

}  // namespace

Assessment assess_pieces(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  const Places places(robot);
  std::vector<JudgedPiece> pieces;
  for (const model::RobotPiece& piece : robot.pieces()) {
    pieces.push_back(judged(piece, places, options));
  }
  std::ranges::stable_sort(pieces, is_worse);
  Assessment whole = pieces.front().found;
  for (const JudgedPiece& one : pieces) {
    whole.pieces.push_back(answer_of(one));
  }
  join_connections(robot, pieces, whole);
  join_gaps(pieces, whole);
  join_equilibrium(robot, pieces, whole.equilibrium);
  join_stability(pieces, whole);
  join_reasons(pieces, whole);
  return whole;
}

}  // namespace holdfast::verdict
