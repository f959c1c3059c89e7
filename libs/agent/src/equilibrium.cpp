// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium.hpp"

namespace holdfast::agent {

/// Faces on which a node has a beam.
std::uint8_t Agent::node_faces(int node) const {
  if (node > 0) {
    const int k = planned_.hosted(node - 1);
    std::uint8_t faces = planned_.total(k);
    for (const base::Direction direction : base::kDirections) {
      if (planned_.neighbour_of(k, direction) >= 0) {
        faces = static_cast<std::uint8_t>(faces | bit(base::index(direction)));
      }
    }
    return faces;
  }
  std::uint8_t faces = used_faces();
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (planned_.at_face(face) >= 0) {
      faces = static_cast<std::uint8_t>(faces | bit(face));
    }
  }
  return faces;
}

void Agent::begin_equilibrium(const Order& order) {
  const auto law = (order.flags & kUnilateralLaw) != 0 ? mechanics::ContactLaw::kUnilateral
                                                       : mechanics::ContactLaw::kRegularised;
  contact_.facet = mechanics::ground_facet(setup_.beam, setup_.section.length, setup_.facet_mm,
                                           static_cast<double>(order.reals[0]), law);
  contact_.lever_mm = static_cast<double>(order.reals[1]);
  const bool is_one_sweep = (order.flags & kOneSweep) != 0;
  if constexpr (kHasAllMethods) {
    is_clustered_ = order.operation == wire::Operation::kClusters;
    if (is_clustered_) {
      begin_clusters();
    }
  }
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    reset(node);
    if constexpr (!kHasAllMethods) {
      continue;
    } else if (!is_one_sweep) {
      gradients_of(i) = gradients_at_rest(node, setup_);
    } else if ((order.flags & kWithSteps) != 0 && i < joined_count()) {
      steps_of(i) = {};
      factor_diagonal(node, setup_, contact_, node_faces(i));
      if (order.count > 0 && !is_clustered_) {
        start_terms(i);
      }
    }
  }
}

/// u := u + t g - theta (last move + change of g), and its leading part goes out.
void Agent::move(const Order& order) {
  const auto length = static_cast<float>(order.reals[0]);
  const auto mix = static_cast<float>(order.reals[1]);
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Gradients& cg = gradients_of(i);
    for (std::size_t k = 0; k < 6; ++k) {
      cg.move[k] = length * cg.g[k] - mix * (cg.move[k] + cg.g[k] - cg.g_before[k]);
      node.u[k] += static_cast<double>(cg.move[k]);
    }
    share_high_part(node);
  }
  middle_ = {};
}

void Agent::start_solve(const Order& order) {
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Gradients& cg = gradients_of(i);
    if ((order.flags & kAdoptStates) != 0) {
      node.state = node.wanted;
      cg.r = base::converted<float>(residual(node, setup_, contact_));
    }
    cg.r_before = cg.r_start;
    cg.r_start = cg.r;
    cg.g_before = cg.g;
    cg.g = {};
    cg.p = {};
    cg.s = {};
    factor_diagonal(node, setup_, contact_, node_faces(i));
    precondition(i, order.count);
    if ((order.flags & kWithScalars) != 0) {
      cg.p = scalar_diagonal(node, setup_, contact_, node_faces(i));
    }
  }
  is_first_step_ = true;
  is_scalar_ = (order.flags & kWithScalars) != 0;
}

/// p := z + beta p, s := w + beta s, g := g + alpha p, r := r - alpha s, z := M^-1 r.
void Agent::gradient_step(const Order& order) {
  const auto alpha = static_cast<float>(order.reals[0]);
  const auto beta = static_cast<float>(order.reals[1]);
  for (int i = 0; i < node_count(); ++i) {
    Gradients& cg = gradients_of(i);
    for (std::size_t k = 0; k < 6; ++k) {
      cg.p[k] = cg.z[k] + beta * cg.p[k];
      cg.s[k] = cg.w[k] + beta * cg.s[k];
      cg.g[k] += alpha * cg.p[k];
      cg.r[k] -= alpha * cg.s[k];
    }
    precondition(i, order.count);
  }
}

/// The first term of the preconditioner: z = M^-1 r, scaled; w holds what is left of r.
void Agent::precondition(int node_index, int degree) {
  Node& node = nodes_[static_cast<std::size_t>(node_index)];
  Gradients& cg = gradients_of(node_index);
  const equilibrium::Interval interval(degree);
  const bool is_joined = node_index < joined_count();
  const auto scale = static_cast<float>(degree == 0 || !is_joined ? 1 : 1 / interval.centre);
  base::Vec6<float> first = solve_diagonal(node, cg.r);
  for (float& value : first) {
    value *= scale;
  }
  node.shared = first;
  cg.z = node.shared;
  cg.w = cg.r;
  rho_ = static_cast<float>(degree == 0 ? 0 : interval.half / interval.centre);
}

void Agent::after_exchange() {
  const bool is_step =
      order_.operation == wire::Operation::kStep || order_.operation == wire::Operation::kTreeStep;
  if (is_step && exchanges_left_ > exchanges_behind_) {
    exchanges_left_ == exchanges_behind_ + 2 ? share_low_part() : find_residuals();
    return;
  }
  if constexpr (kHasAllMethods) {
    const Exchanged what = exchanged();
    switch (order_.operation) {
      case wire::Operation::kJacobi:
        jacobi_step();
        break;
      case wire::Operation::kStart:
      case wire::Operation::kGradient:
        polynomial_step();
        break;
      case wire::Operation::kStep:
        has_clusters() ? next_terms_with_clusters() : next_terms();
        break;
      case wire::Operation::kBegin:
      case wire::Operation::kClusters:
        for (int i = 0; i < joined_count() && what == Exchanged::kChoice; ++i) {
          start_terms(i);
        }
        if (what == Exchanged::kTerm) {
          next_terms();
        }
        break;
      default:
        break;
    }
  }
}

void Agent::share_low_part() {
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 6; ++k) {
      node.shared[k] = static_cast<float>(node.u[k] - leading_part(node.u[k]));
    }
  }
}

/// The next term of the preconditioner, and after the last one w = A z.
void Agent::polynomial_step() {
  const equilibrium::Interval interval(order_.count);
  const double sigma = interval.half > 0 ? interval.centre / interval.half : 1;
  const double rho = 1 / (2 * sigma - static_cast<double>(rho_));
  const auto keep = static_cast<float>(rho * static_cast<double>(rho_));
  const auto gain = static_cast<float>(interval.half > 0 ? 2 * rho / interval.half : 0);
  const bool is_last = exchanges_left_ == 1;
  for (int i = 0; i < joined_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Gradients& cg = gradients_of(i);
    if (node.is_fixed) {
      cg.w = {};
      continue;
    }
    if (node.is_ground) {
      base::add_to(cg.image, base::converted<float>(mechanics::symmetric_product(
                                 contact_.facet, node.state, node.is_held,
                                 base::converted<double>(node.shared))));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      cg.w[k] -= cg.image[k];
    }
    if (is_last) {
      for (std::size_t k = 0; k < 6; ++k) {
        cg.w[k] = cg.r[k] - cg.w[k];
      }
      continue;
    }
    const base::Vec6<float> term = solve_diagonal(node, cg.w);
    for (std::size_t k = 0; k < 6; ++k) {
      node.shared[k] = keep * node.shared[k] + gain * term[k];
    }
    base::add_to(cg.z, node.shared);
  }
  rho_ = static_cast<float>(rho);
}

/// One step of Eq. (14), written for the correction g: g := g + beta D^-1 r(u + g), with the facet
/// in the state that the law prescribes at u + g. With u = 0 it is Eq. (14) as printed.
void Agent::jacobi_step() {
  double error = 0;
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Gradients& cg = gradients_of(i);
    if (node.is_fixed) {
      continue;
    }
    base::Vec6<float> rest{};
    const base::Vec6<double> here = facet_force_along(node, contact_, cg.g, 1);
    const base::Vec6<double> start = facet_force_along(node, contact_, cg.g, 0);
    for (std::size_t k = 0; k < 6; ++k) {
      rest[k] = cg.r_start[k] - cg.image[k] - static_cast<float>(here[k] - start[k]);
    }
    const mechanics::ContactState state = state_along(node, contact_, cg.g, 1);
    if (node.is_ground && !is_first_step_ && !(state == node.state)) {
      node.state = state;
      if (is_scalar_) {
        cg.p = scalar_diagonal(node, setup_, contact_, node_faces(i));
      } else {
        factor_diagonal(node, setup_, contact_, node_faces(i));
      }
    }
    error += ratio_error(base::converted<double>(rest), setup_, contact_);
    const base::Vec6<float> step = is_scalar_ ? rest : solve_diagonal(node, rest);
    for (std::size_t k = 0; k < 6; ++k) {
      cg.g[k] += static_cast<float>(kJacobiWeight) * (is_scalar_ ? step[k] / cg.p[k] : step[k]);
    }
    node.shared = cg.g;
  }
  is_first_step_ = false;
  jacobi_error_ = static_cast<float>(error);
}

/// What the exchange under way shares, and so where the beams' forces go.
Agent::Exchanged Agent::exchanged() const {
  if constexpr (!kHasAllMethods) {
    return Exchanged::kDisplacement;
  }
  switch (order_.operation) {
    case wire::Operation::kHigh:
    case wire::Operation::kLow:
      return Exchanged::kDisplacement;
    case wire::Operation::kStep:
    case wire::Operation::kTreeStep:
      return exchanges_left_ > exchanges_behind_ ? Exchanged::kDisplacement : Exchanged::kTerm;
    case wire::Operation::kBegin:
      return Exchanged::kTerm;
    case wire::Operation::kClusters:
      return exchanges_left_ > exchanges_behind_ ? Exchanged::kChoice : Exchanged::kTerm;
    default:
      return Exchanged::kGradient;
  }
}

/// All beams of this module and of those it emulates, for what has been exchanged.
void Agent::exchange_forces() {
  const Exchanged what = exchanged();
  if (kHasAllMethods && what == Exchanged::kChoice) {
    return meet_neighbours();
  }
  for (int i = 0; i < node_count() && what == Exchanged::kGradient; ++i) {
    gradients_of(i).image = {};
  }
  const std::uint8_t faces = used_faces();
  const auto& vectors = vectors_[tag_ & 1U];
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const int k = planned_.at_face(face);
    if ((faces & bit(face)) != 0) {
      add_beam(face, vectors[static_cast<std::size_t>(face)]);
    } else if (k >= 0 && is_apart()) {
      add_beam_apart(face);
    } else if (k >= 0) {
      add_beam(face, planned_vector_[static_cast<std::size_t>(k)]);
    }
  }
  if (is_apart()) {
    return;
  }
  add_planned_beams();
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    const auto& force = planned_force_[static_cast<std::size_t>(planned_.hosted(i))];
    for (std::size_t k = 0; k < 6; ++k) {
      if (what == Exchanged::kDisplacement) {
        nodes_[static_cast<std::size_t>(1 + i)].force[k] += force[k];
      } else if (what == Exchanged::kTerm) {
        steps_of(1 + i).w[k] -= force[k];
      } else {
        gradients_of(1 + i).image[k] = static_cast<float>(force[k]);
      }
    }
  }
}

/// The beam at `face` of this module: force on it, on a planned module there, load in the middle.
void Agent::add_beam(int face, const base::Vec6<float>& other) {
  using base::converted;
  const auto direction = static_cast<base::Direction>(face);
  Node& node = nodes_[0];
  const int k = planned_.at_face(face);
  const Exchanged what = exchanged();
  if (what == Exchanged::kGradient) {
    const auto& beam = setup_.beam_float;
    const auto& mine = node.shared;  // As the neighbours have it.
    const auto theirs = other;
    base::add_to(gradients_of(0).image, mechanics::end_force(beam, direction, mine, theirs));
    if (k >= 0) {
      // A planned module that has stood apart has all terms to catch up with.
      const auto& whole = planned_.is_any_remote() && sweep::is_preconditioned(order_.operation)
                              ? gradients_of(0).z
                              : mine;
      base::add_to(
          planned_force_[static_cast<std::size_t>(k)],
          converted<double>(mechanics::end_force(beam, base::opposite(direction), theirs, whole)));
    }
    return;
  }
  const auto mine = converted<double>(node.shared);
  const auto theirs = converted<double>(other);
  const base::Vec6<double> force = mechanics::end_force(setup_.beam, direction, mine, theirs);
  if (k >= 0) {
    base::add_to(planned_force_[static_cast<std::size_t>(k)],
                 mechanics::end_force(setup_.beam, base::opposite(direction), theirs, mine));
  }
  if (what == Exchanged::kTerm) {
    for (std::size_t i = 0; i < 6; ++i) {
      steps_of(0).w[i] -= force[i];
    }
    return;
  }
  base::add_to(node.force, force);
  const base::Vec6<double> middle = mechanics::middle_force(setup_.beam, direction, mine, theirs);
  MiddleLoad& load = middle_[static_cast<std::size_t>(face)];
  load.axial_n += middle[2];
  load.bending_x_nmm += middle[3];
  load.bending_y_nmm += middle[4];
}

/// Beams between planned modules, both emulated here.
void Agent::add_planned_beams() {
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    const int k = planned_.hosted(i);
    for (const base::Direction direction : base::kDirections) {
      const int other = planned_.neighbour_of(k, direction);
      if (other < 0) {
        continue;
      }
      const auto mine = base::converted<double>(planned_vector_[static_cast<std::size_t>(k)]);
      const auto theirs = base::converted<double>(planned_vector_[static_cast<std::size_t>(other)]);
      base::add_to(planned_force_[static_cast<std::size_t>(k)],
                   mechanics::end_force(setup_.beam, direction, mine, theirs));
    }
  }
}

double Agent::ratio_of(const MiddleLoad& load, base::Direction direction) const {
  const base::Vec6<double> middle = {0, 0, load.axial_n, load.bending_x_nmm, load.bending_y_nmm, 0};
  return mechanics::load_ratio(
      mechanics::connection_load(middle), setup_.facet_mm,
      base::is_vertical(direction) ? setup_.strength_vertical_n : setup_.strength_lateral_n);
}

/// visit(visitor, cell, direction, load ratio) for every connection of this module, and once for
/// every one between planned modules emulated here.
void Agent::visit_all_loads(LoadVisit visit, void* visitor) const {
  const std::uint8_t faces = node_faces(0);
  for (const base::Direction direction : base::kDirections) {
    if ((faces & bit(base::index(direction))) != 0) {
      visit(visitor, nodes_[0].cell, direction,
            ratio_of(middle_[static_cast<std::size_t>(base::index(direction))], direction));
    }
  }
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    for (const base::Direction direction : base::kDirections) {
      const int other = planned_.neighbour_of(planned_.hosted(i), direction);
      if (other < 0 || base::index(direction) % 2 != 0) {
        continue;
      }
      const Node& node = nodes_[static_cast<std::size_t>(1 + i)];
      const base::Vec6<double> middle =
          mechanics::middle_force(setup_.beam, direction, node.u,
                                  nodes_[static_cast<std::size_t>(planned_.node_of(other))].u);
      visit(visitor, node.cell, direction, ratio_of({middle[2], middle[3], middle[4]}, direction));
    }
  }
}

bool Agent::find_load_ratio(const base::Cell& cell, base::Direction direction, float& ratio) const {
  bool is_found = false;
  visit_loads([&](const base::Cell& here, base::Direction there, double value) {
    if (here == cell && there == direction) {
      ratio = static_cast<float>(value);
      is_found = true;
    }
  });
  return is_found;
}

/// Error bound, largest load ratio, facets that want another state, their hash.
Report Agent::residual_report() {
  Report report;
  report.reals[1] = kNoLoadRatio;
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Gradients& cg = gradients_of(i);
    node.wanted = state_along(node, contact_, cg.g, 0);
    if (node.is_ground && !(node.wanted == node.state)) {
      ++report.extent;
      if ((order_.flags & kFollowStates) != 0) {
        node.state = node.wanted;
      }
    }
    equilibrium::report_facet(report, node);
    const base::Vec6<double> rest = residual(node, setup_, contact_);
    report.reals[0] += static_cast<float>(ratio_error(rest, setup_, contact_));
    cg.r = base::converted<float>(rest);
  }
  visit_loads([&](const base::Cell&, base::Direction, double ratio) {
    report.reals[1] = larger(report.reals[1], static_cast<float>(ratio));
  });
  return report;
}

/// (r, z), (z, w), and the bound on the error that r means.
Report Agent::product_report() const {
  float residual_product = 0;
  float image_product = 0;
  double error = 0;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const Gradients& cg = gradients_of(i);
    residual_product += base::dot(cg.r, cg.z);
    image_product += base::dot(cg.z, cg.w);
    error += node.is_fixed ? 0 : ratio_error(base::converted<double>(cg.r), setup_, contact_);
  }
  Report report;
  report.reals[0] = static_cast<float>(residual_product);
  report.reals[1] = static_cast<float>(image_product);
  report.reals[2] = static_cast<float>(error);
  return report;
}

/// The slope of the energy along g, at t = 0 and at four places in (low, high].
Report Agent::slope_report() const {
  if ((order_.flags & kMixProducts) != 0) {
    return mix_report();
  }
  Report report;
  const auto low = static_cast<double>(order_.reals[0]);
  const auto high = static_cast<double>(order_.reals[1]);
  std::array<double, 5> sums{};
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const Gradients& cg = gradients_of(i);
    if (node.is_fixed) {
      continue;
    }
    // Node by node the sum is small near the equilibrium, so its digits are good.
    for (int place = 0; place <= 4; ++place) {
      const double t = place == 0 ? 0 : low + (high - low) * place / 4;
      base::Vec6<double> rest = facet_force_along(node, contact_, cg.g, t);
      rest[2] += setup_.weight_n;
      double slope = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        rest[k] += node.force[k] + t * static_cast<double>(cg.image[k]);
        slope += rest[k] * static_cast<double>(cg.g[k]);
      }
      sums[static_cast<std::size_t>(place)] += slope;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    report.reals[i] = static_cast<float>(sums[i]);
  }
  return report;
}

/// (dg, r) and (dg, dr), d: the change since the solve before.
Report Agent::mix_report() const {
  Report report;
  for (int i = 0; i < node_count(); ++i) {
    const Gradients& cg = gradients_of(i);
    for (std::size_t k = 0; k < 6; ++k) {
      const float change = cg.g[k] - cg.g_before[k];
      report.reals[0] += static_cast<float>(change * cg.r_start[k]);
      report.reals[1] += static_cast<float>(change * (cg.r_start[k] - cg.r_before[k]));
    }
  }
  return report;
}

/// Releases open facets and holds pressed ones (count: how many changed); number: open but held.
Report Agent::hold_report() {
  Report report;
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    if (!node.is_ground) {
      continue;
    }
    const bool frees = (order_.flags & kFreeOpen) != 0;
    if (!node.state.pressed && node.is_held && (frees || !node.was_released)) {
      node.is_held = false;
      node.was_released = true;
      ++report.count;
    } else if (node.state.pressed && !node.is_held && !frees) {
      node.is_held = true;
      ++report.count;
    }
    report.number += !node.state.pressed && node.is_held ? 1U : 0U;
  }
  return report;
}

Report Agent::loads_report() {
  Report report;
  report.reals[0] = kNoLoadRatio;
  report.number = static_cast<std::uint32_t>(node_count());
  own_ratio_ = 0;
  visit_loads([&](const base::Cell& cell, base::Direction direction, double ratio) {
    const auto value = static_cast<float>(ratio);
    Report own;
    own.reals[0] = value;
    own.cell = cell;
    own.direction = direction;
    own.count = mechanics::breaks(ratio) ? 1 : 0;
    merge(wire::Operation::kLoads, report, own);
    if (cell == nodes_[0].cell) {
      own_ratio_ = larger(own_ratio_, value);
    }
  });
  return report;
}

}  // namespace holdfast::agent
