// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cone.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::limit {
namespace {

bool is_number(const ConePart& u) { return u.size() == 1; }

/// u' J u, accurate at the boundary.
double square(const ConePart& u) { return inside(u) * (u[0] + u.tail<2>().norm()); }

/// What W / eta does, or with `sign` -1 its inverse.
ConePart hyperbolic(const Eigen::Vector3d& w, double sign, const ConePart& u) {
  const Eigen::Vector2d side = sign * w.tail<2>();
  const double along = side.dot(u.tail<2>());
  ConePart result(3);
  result[0] = w[0] * u[0] + along;
  result.tail<2>() = u.tail<2>() + (u[0] + along / (1 + w[0])) * side;
  return result;
}

}  // namespace

ConePart cone_centre(Eigen::Index size) {
  ConePart centre = ConePart::Zero(size);
  centre[0] = 1;
  return centre;
}

double inside(const ConePart& u) { return is_number(u) ? u[0] : u[0] - u.tail<2>().norm(); }

ConePart jordan_product(const ConePart& u, const ConePart& v) {
  if (is_number(u)) {
    return u * v[0];
  }
  ConePart result(3);
  result[0] = u.dot(v);
  result.tail<2>() = u[0] * v.tail<2>() + v[0] * u.tail<2>();
  return result;
}

ConePart jordan_quotient(const ConePart& v, const ConePart& u) {
  if (is_number(u)) {
    return v / u[0];
  }
  ConePart result(3);
  result[0] = (u[0] * v[0] - u.tail<2>().dot(v.tail<2>())) / square(u);
  result.tail<2>() = (v.tail<2>() - result[0] * u.tail<2>()) / u[0];
  return result;
}

double longest_step(const ConePart& u, const ConePart& d, double most) {
  if (is_number(u)) {
    return d[0] < 0 ? std::min(most, -u[0] / d[0]) : most;
  }
  // The first root of (u + t d)' J (u + t d) = a t^2 + 2 b t + c; c > 0.
  const double a = d[0] * d[0] - d.tail<2>().squaredNorm();
  const double b = u[0] * d[0] - u.tail<2>().dot(d.tail<2>());
  const double c = square(u);
  const double root = b * b - a * c;
  if (a >= 0 && b >= 0) {
    return most;
  }
  return std::min(most, c / (-b + std::sqrt(std::max(root, 0.0))));
}

Scaling::Scaling(const ConePart& s, const ConePart& z) {
  if (is_number(s)) {
    eta_ = std::sqrt(s[0] / z[0]);
    return;
  }
  const double s_root = std::sqrt(square(s));
  const double z_root = std::sqrt(square(z));
  const Eigen::Vector3d s_bar = s / s_root;
  Eigen::Vector3d z_bar = z / z_root;
  const double gamma = std::sqrt((1 + s_bar.dot(z_bar)) / 2);
  z_bar.tail<2>() *= -1;
  w_ = (s_bar + z_bar) / (2 * gamma);
  eta_ = std::sqrt(s_root / z_root);
}

ConePart Scaling::times(const ConePart& u) const {
  return is_number(u) ? ConePart(eta_ * u) : ConePart(eta_ * hyperbolic(w_, 1, u));
}

ConePart Scaling::inverse_times(const ConePart& u) const {
  return is_number(u) ? ConePart(u / eta_) : ConePart(hyperbolic(w_, -1, u) / eta_);
}

/// The rows of R are along the eigenvectors of W^-1: (1, -n), (1, n) and across, with n along w.
ConeRows Scaling::root_times(const ConeRows& G) const {
  if (G.rows() == 1) {
    return G / eta_;
  }
  const double length = w_.tail<2>().norm();
  const Eigen::Vector2d n =
      length > 0 ? Eigen::Vector2d(w_.tail<2>() / length) : Eigen::Vector2d(1, 0);
  const double largest = w_[0] + length;
  const auto along = (n[0] * G.row(1) + n[1] * G.row(2)).eval();
  ConeRows result(3, 6);
  result.row(0) = largest * std::sqrt(0.5) / eta_ * (G.row(0) - along);
  result.row(1) = std::sqrt(0.5) / (largest * eta_) * (G.row(0) + along);
  result.row(2) = (n[0] * G.row(2) - n[1] * G.row(1)) / eta_;
  return result;
}

}  // namespace holdfast::limit
