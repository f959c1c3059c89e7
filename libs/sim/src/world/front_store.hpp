// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/agent/methods/front_contact.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/base/cell.hpp"

namespace holdfast::sim {

/// The memory for fronts of all modules. A page that is never written costs nothing.
class FrontStore {
 public:
  FrontStore(std::size_t module_count, bool plans_many, bool has_surroundings)
      : modules_(module_count) {
    Sizes sizes = plans_many ? kManyPlanned : kFewPlanned;
    sizes.reals *= has_surroundings ? 2 : 1;
    const std::size_t contact_reals = agent::contact_reals(sizes.kept);
    for (Module& module : modules_) {
      module.nodes = std::make_unique<agent::FrontNode[]>(sizes.nodes);
      module.reals = std::unique_ptr<float[]>(new float[sizes.reals]);
      module.kept = std::make_unique<agent::KeptNode[]>(sizes.kept);
      module.touching.resize(has_surroundings ? sizes.kept : 0);
      module.contact = std::unique_ptr<double[]>(new double[contact_reals]);
      module.queues = std::unique_ptr<std::uint8_t[]>(new std::uint8_t[kQueueBytes]);
      module.memory = {.nodes = {module.nodes.get(), sizes.nodes},
                       .reals = {module.reals.get(), sizes.reals},
                       .kept = {module.kept.get(), sizes.kept},
                       .contact = {module.contact.get(), contact_reals},
                       .touching = module.touching,
                       .queues = {module.queues.get(), kQueueBytes}};
    }
  }

  agent::FrontMemory& memory_of(std::size_t module) { return modules_[module].memory; }

 private:
  static constexpr std::size_t kQueueBytes = agent::kFaceCountMax * agent::Link::kLentBytes;

  struct Sizes {
    std::size_t nodes;
    std::size_t reals;
    std::size_t kept;
  };

  static constexpr Sizes kFewPlanned = {.nodes = 256, .reals = 48'000, .kept = 60};
  /// A group of 30 is in the front of its host, and above it with all that it touches.
  static constexpr Sizes kManyPlanned = {.nodes = 512, .reals = 192'000, .kept = 60};

  struct Module {
    std::unique_ptr<agent::FrontNode[]> nodes;
    std::unique_ptr<float[]> reals;
    std::unique_ptr<agent::KeptNode[]> kept;
    std::vector<agent::Surroundings> touching;
    std::unique_ptr<double[]> contact;
    std::unique_ptr<std::uint8_t[]> queues;
    agent::FrontMemory memory;
  };

  std::vector<Module> modules_;
};

}  // namespace holdfast::sim
