// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "formats/foreign_reading.hpp"

namespace holdfast::io {

using MeshPoint = std::array<double, 3>;
using MeshTriangle = std::array<MeshPoint, 3>;

/// Adds a module for every cell whose centre is inside a closed surface: above an odd number of its
/// triangles. Cells have the edge ReadOptions::mesh_pitch, and the corner of one is the lowest
/// corner of the surface. Errors: no pitch; the surface is not closed, or needs too many cells.
void fill_mesh(ForeignReading& reading, const std::vector<MeshTriangle>& triangles);

}  // namespace holdfast::io
