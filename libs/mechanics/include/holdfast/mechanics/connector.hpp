// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/mechanics/beam.hpp"

/// Decides whether a connection holds, by Eq. (17) of [Piranda 2021].
namespace holdfast::mechanics {

/// The connector that holds two modules together: the data of Eq. (17).
template <class Real>
struct Connector {
  Real width = 0;     ///< mm, of the face: twice the lever on which bending opens the connection.
  Real strength = 0;  ///< N, the tension that it holds.
};

/// The connection of two modules whose connectors differ holds what the weaker one of them holds.
template <class Real>
constexpr const Connector<Real>& weaker(const Connector<Real>& a, const Connector<Real>& b) {
  return b.strength < a.strength ? b : a;
}

/// The load of a connection, in its middle.
template <class Real>
struct ConnectionLoad {
  Real axial = 0;    ///< N; tension is positive.
  Real bending = 0;  ///< N mm; the larger of |mx| and |my|.
};

/// The load of a connection, given the force in its middle, Eq. (16), local frame.
template <class Real>
ConnectionLoad<Real> connection_load(const base::Vec6<Real>& middle_force);

/// (2 bending / width + axial) / strength. The connection breaks at 1 or more; a compressed
/// connection can have a negative ratio. `width` (mm) is that of the face, the lever of Eq. (17);
/// `strength` (N) is the tension that the connector holds.
template <class Real>
Real load_ratio(const ConnectionLoad<Real>& load, Real width, Real strength);

/// The load ratio of a connection from the force in its middle, Eq. (16), local frame.
template <class Real>
Real load_ratio(const Connector<Real>& connector, const base::Vec6<Real>& middle_force) {
  return load_ratio(connection_load(middle_force), connector.width, connector.strength);
}

/// Decides whether a load ratio in a module's own precision breaks: 1 or more does, and so does
/// what is not a number. A module's numbers have seven digits; on a host, whose rounding is known
/// to be smaller, verdict::breaks() decides.
template <class Real>
constexpr bool breaks(Real load_ratio) {
  return !(load_ratio < 1);
}

}  // namespace holdfast::mechanics
