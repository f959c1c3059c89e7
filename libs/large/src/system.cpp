// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "system.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/connector_law.hpp"

namespace holdfast::large {
namespace {

using base::at;
using base::Mat6;
using mechanics::BeamDeformation;
using mechanics::EndForces;
using mechanics::EndTangent;
using mechanics::Pose;

/// What the factorization takes for a block that fills in, a node and an edge; twice where torques
/// make the tangent unsymmetric.
constexpr std::size_t kLargeBlockBytes = sizeof(Mat6<double>) + 24;
constexpr std::size_t kLargeNodeBytes = 4 * sizeof(Mat6<double>) + 600;
constexpr std::size_t kLargeEdgeBytes = 3 * sizeof(Mat6<double>) + sizeof(BeamDeformation) + 200;

double largest_of(const Vec& v, std::size_t first) {
  return std::max({std::abs(v[first]), std::abs(v[first + 1]), std::abs(v[first + 2])});
}

/// (A + A') / 2
Mat6<double> symmetric_part(const Mat6<double>& block) {
  Mat6<double> result;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      result.at(i, k) = (block.at(i, k) + block.at(k, i)) / 2;
    }
  }
  return result;
}

double length_of(const mechanics::Vector3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

/// NaN counts as more than anything.
Size size_of(std::span<const Vec> vectors) {
  Size size;
  for (const Vec& v : vectors) {
    for (std::size_t k = 0; k < 6; ++k) {
      double& part = k < 3 ? size.translation : size.rotation;
      part = std::abs(v[k]) <= part ? part : std::abs(v[k]);
    }
  }
  return size;
}

std::unique_ptr<System> System::make(const model::Robot& robot, const Options& options) {
  std::unique_ptr<System> system(new System(robot, options));
  return system->make_factors(options) ? std::move(system) : nullptr;
}

System::System(const model::Robot& robot, const Options& options)
    : robot_(robot),
      lattice_beam_(model::beam_section(robot.material()), robot.lattice()),
      law_(solver::facet_law(robot, lattice_beam_,
                             {.law = mechanics::ContactLaw::kUnilateral, .gamma = 0})),
      beams_(lattice_beam_, robot.lattice()),
      pitch_(robot.material().pitch_mm),
      is_bonded_(options.is_bonded),
      thread_count_(options.thread_count),
      team_(options.thread_count, robot.connections().size()),
      node_of_module_(robot.modules().size(), -1) {
  for (std::size_t i = 0; i < node_of_module_.size(); ++i) {
    if (robot.modules()[i].support == model::Support::kFixed) {
      continue;
    }
    node_of_module_[i] = static_cast<std::int32_t>(module_of_node_.size());
    module_of_node_.push_back(i);
    loads_.push_back(robot.loads()[i]);
    const double torque = largest_of(loads_.back(), 3);
    has_torques_ = has_torques_ || torque > 0;
    load_size_ = std::max({load_size_, largest_of(loads_.back(), 0), torque / pitch_});
  }
}

bool System::make_factors(const Options& options) {
  std::vector<solver::Edge> edges;
  for (const model::Connection connection : robot_.connections()) {
    connections_.push_back(connection);
    const solver::Edge edge{node_of_module_[at(connection.a)], node_of_module_[at(connection.b)]};
    if (edge.a >= 0 && edge.b >= 0) {
      edges.push_back(edge);
    }
  }
  deformations_.resize(connections_.size());
  facet_deformations_.resize(robot_.facets().size());
  const std::size_t always =
      kLargeNodeBytes * module_of_node_.size() + kLargeEdgeBytes * connections_.size();
  const std::size_t left =
      options.memory_bytes_max > always ? options.memory_bytes_max - always : 0;
  lu_.emplace(module_of_node_.size(), edges, left / (kLargeBlockBytes * (has_torques_ ? 2 : 1)),
              solver::Symmetry::kSymmetric);
  return !lu_->is_too_large();
}

Configuration System::at_rest() const {
  Configuration here;
  here.poses.resize(robot_.modules().size());
  for (const model::Facet& facet : robot_.facets()) {
    here.facets.push_back({.module = at(facet.module),
                           .direction = facet.direction,
                           .is_bonded = facet.is_bonded() || is_bonded_,
                           .state = mechanics::kStuck});
  }
  return here;
}

BeamDeformation System::facet_deformation(const Configuration& here, std::size_t facet) const {
  const solver::FacetState& state = here.facets[facet];
  return beam(state.direction).deformation(here.poses[state.module], Pose{});
}

bool System::look_up_facets(Configuration& here) const {
  bool is_changed = false;
  for (std::size_t i = 0; i < here.facets.size(); ++i) {
    solver::FacetState& facet = here.facets[i];
    const Vec trial = beam(facet.direction).stress(facet_deformation(here, i));
    const mechanics::ContactState state = law_.state_for(facet, trial);
    is_changed = is_changed || state != facet.state;
    facet.state = state;
  }
  return is_changed;
}

/// The force of the contact law, in whose local frame stresses are, and what is kept of a hold.
Vec System::facet_stress(const Configuration& here, std::size_t facet,
                         const BeamDeformation& deformation) const {
  const solver::FacetState& state = here.facets[facet];
  const Vec trial = beam(state.direction).stress(deformation);
  Vec stress = base::multiply(
      mechanics::corrector(law_.ground(state.direction), state.state, state.is_held), trial);
  if (!here.kept.empty()) {
    base::add_to(stress, here.kept[facet]);
  }
  return stress;
}

Vec System::sideways_stress(const Configuration& here, std::size_t facet) const {
  const Vec stress = facet_stress(here, facet, facet_deformation(here, facet));
  return {stress[0], stress[1], 0, 0, 0, stress[5]};
}

EndForces System::facet_forces(const Configuration& here, std::size_t facet) const {
  const BeamDeformation& deformation = facet_deformations_[facet];
  return beam(here.facets[facet].direction)
      .end_forces(deformation, facet_stress(here, facet, deformation));
}

std::vector<Vec> System::residual(const Configuration& here) {
  std::vector<EndForces> forces(connections_.size());
  team_.share(0, connections_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const model::Connection& pair = connections_[i];
      const mechanics::LargeBeam& own = beam(pair.direction);
      deformations_[i] = own.deformation(here.poses[at(pair.a)], here.poses[at(pair.b)]);
      forces[i] = own.end_forces(deformations_[i], own.stress(deformations_[i]));
    }
  });
  std::vector<Vec> rest(loads_.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      rest[i][k] = here.factor * loads_[i][k];
    }
  }
  const auto subtract = [&](std::size_t module, const Vec& force) {
    if (node_of_module_[module] >= 0) {
      base::add_times(rest[at(node_of_module_[module])], -1, force);
    }
  };
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    subtract(at(connections_[i].a), forces[i].p);
    subtract(at(connections_[i].b), forces[i].q);
  }
  for (std::size_t i = 0; i < here.facets.size(); ++i) {
    facet_deformations_[i] = facet_deformation(here, i);
    subtract(here.facets[i].module, facet_forces(here, i).p);
  }
  return rest;
}

void System::add_facet_tangents(const Configuration& here, std::vector<Mat6<double>>& diagonal) {
  for (std::size_t i = 0; i < here.facets.size(); ++i) {
    const solver::FacetState& facet = here.facets[i];
    const mechanics::LargeBeam& own = beam(facet.direction);
    Mat6<double> stiffness =
        mechanics::corrector(law_.ground(facet.direction), facet.state, facet.is_held);
    for (int column = 0; column < 6; ++column) {
      for (int row = 0; row < 6; ++row) {
        stiffness.at(row, column) *= own.stiffness()[at(column)];
      }
    }
    const BeamDeformation& deformation = facet_deformations_[i];
    const EndTangent tangent =
        own.tangent(deformation, facet_stress(here, i, deformation), stiffness);
    base::add_to(diagonal[at(node_of_module_[facet.module])], tangent.pp);
  }
}

bool System::factor(const Configuration& here, bool is_symmetric) {
  ++factor_count_;
  std::vector<EndTangent> tangents(connections_.size());
  team_.share(0, connections_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tangents[i] = beam(connections_[i].direction).tangent(deformations_[i]);
    }
  });
  const bool has_symmetry = is_symmetric || !has_torques_;
  lu_->set_symmetry(has_symmetry ? solver::Symmetry::kSymmetric : solver::Symmetry::kNone);
  std::vector<Mat6<double>> diagonal(loads_.size());
  std::size_t edge = 0;
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    const std::int32_t a = node_of_module_[at(connections_[i].a)];
    const std::int32_t b = node_of_module_[at(connections_[i].b)];
    if (a >= 0) {
      base::add_to(diagonal[at(a)], tangents[i].pp);
    }
    if (b >= 0) {
      base::add_to(diagonal[at(b)], tangents[i].qq);
    }
    if (a >= 0 && b >= 0) {
      lu_->set_edge(edge++, tangents[i].pq);
    }
  }
  add_facet_tangents(here, diagonal);
  for (std::size_t node = 0; node < diagonal.size(); ++node) {
    for (int i = 0; i < 6; ++i) {
      diagonal[node].at(i, i) += i < 3 ? shift_ / (pitch_ * pitch_) : shift_;
    }
    lu_->set_diagonal(node, has_symmetry ? symmetric_part(diagonal[node]) : diagonal[node]);
  }
  return lu_->factor(thread_count_);
}

std::vector<Vec> System::solve(std::vector<Vec> right) const {
  lu_->solve(right);
  return right;
}

void System::move(Configuration& here, std::span<const Vec> step, double share) const {
  for (std::size_t node = 0; node < step.size(); ++node) {
    Pose& pose = here.poses[module_of_node_[node]];
    pose = mechanics::moved(pose, base::sum_of(Vec{}, share, step[node]));
  }
}

std::vector<Vec> System::by_node(const std::vector<Vec>& by_module) const {
  std::vector<Vec> vectors(module_of_node_.size());
  for (std::size_t node = 0; node < vectors.size(); ++node) {
    vectors[node] = by_module[module_of_node_[node]];
  }
  return vectors;
}

double System::edge_strain(std::size_t connection) const {
  const Vec& e = deformations_[connection].strain;
  return (std::abs(e[2]) + robot_.material().facet_mm / 2 * std::sqrt(e[3] * e[3] + e[4] * e[4])) /
         beam(connections_[connection].direction).length();
}

State System::state(const Configuration& here) const {
  State state{.factor = here.factor, .poses = here.poses, .facets = here.facets};
  const std::size_t count = connections_.size();
  state.middle_force.resize(count);
  state.load_ratio.resize(count);
  state.gap_mm.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const mechanics::LargeBeam& own = beam(connections_[i].direction);
    const BeamDeformation& deformation = deformations_[i];
    const model::ConnectorLaw& law = robot_.connector(connections_[i]);
    const Vec stress = own.stress(deformation);
    state.middle_force[i] = own.middle_force(deformation, stress);
    state.load_ratio[i] = model::load_ratio(law, state.middle_force[i]).ratio;
    state.gap_mm[i] =
        mechanics::gap_mm(law, lattice_beam_.stiffness(connections_[i].direction), stress,
                          [](double x, double y) { return std::sqrt(x * x + y * y); });
    if (!state.worst || state.load_ratio[i] > state.load_ratio[*state.worst]) {
      state.worst = i;
    }
    state.edge_strain_max = std::max(state.edge_strain_max, edge_strain(i));
  }
  state.load_ratio_max = state.worst ? state.load_ratio[*state.worst] : 0;
  for (const Pose& pose : here.poses) {
    state.displacement_max_mm = std::max(state.displacement_max_mm, length_of(pose.displacement));
    state.rotation_max_rad =
        std::max(state.rotation_max_rad, length_of(mechanics::rotation_vector(pose.rotation)));
  }
  for (std::size_t i = 0; i < here.facets.size(); ++i) {
    Vec force = facet_forces(here, i).p;
    for (double& part : force) {
      part = -part;
    }
    state.facet_force.push_back(force);
  }
  return state;
}

}  // namespace holdfast::large
