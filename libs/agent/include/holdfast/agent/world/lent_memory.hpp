// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/world/surroundings.hpp"

namespace holdfast::agent {

class FreeFaces;
class Stages;
struct FrontMemory;
struct KeptChanges;
struct MoreFaces;
struct MorePlanned;

/// What a module needs besides its own memory where its robot asks for it, lent by whoever runs it;
/// not owned.
struct LentMemory {
  FrontMemory* fronts = nullptr;    ///< Null: no method with fronts.
  FreeFaces* free_faces = nullptr;  ///< Null: free faces are not judged.
  Stages* stages = nullptr;         ///< Null: steps are not judged in stages.
  /// One by node, for all planned ones that there may be; null: there is nothing but a floor.
  Surroundings* surroundings = nullptr;
  const Environment* environment = nullptr;  ///< Not null where there are surroundings.
  MoreFaces* faces = nullptr;                ///< Null: the module is a cube.
  MorePlanned* planned = nullptr;            ///< Null: kPlannedMax planned modules at most.
  AcrossLoads* across = nullptr;             ///< Null: Eq. (17) is the law of every connection.
  KeptChanges* changes = nullptr;            ///< Null: iterations are not deflated (deflation.hpp).
};

}  // namespace holdfast::agent
