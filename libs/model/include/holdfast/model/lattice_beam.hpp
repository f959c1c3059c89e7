// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/mechanics/lattice_beam.hpp"

/// The beams of a robot's lattice, as robots have them.
namespace holdfast::model {

using mechanics::LatticeBeam;
using mechanics::Rotation;
using mechanics::rotation_along;

}  // namespace holdfast::model
