// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/agent/front_contact.hpp"
#include "holdfast/agent/link.hpp"
#include "holdfast/base/cell.hpp"

namespace holdfast::sim {

/// The memory for fronts of all modules. A page that is never written costs nothing.
class FrontStore {
 public:
  explicit FrontStore(std::size_t module_count) : modules_(module_count) {
    for (Module& module : modules_) {
      module.nodes = std::make_unique<agent::FrontNode[]>(kNodes);
      module.reals = std::unique_ptr<float[]>(new float[kReals]);
      module.contact = std::unique_ptr<double[]>(new double[kContactReals]);
      module.memory = {.nodes = {module.nodes.get(), kNodes},
                       .reals = {module.reals.get(), kReals},
                       .contact = {module.contact.get(), kContactReals},
                       .queues = module.queues};
    }
  }

  agent::FrontMemory& memory_of(std::size_t module) { return modules_[module].memory; }

 private:
  static constexpr std::size_t kNodes = 256;
  static constexpr std::size_t kReals = 48'000;
  static constexpr std::size_t kContactReals = agent::contact_reals(agent::kKeptMax);

  struct Module {
    std::unique_ptr<agent::FrontNode[]> nodes;
    std::unique_ptr<float[]> reals;
    std::unique_ptr<double[]> contact;
    std::array<std::uint8_t, base::kDirectionCount * agent::Link::kLentBytes> queues{};
    agent::FrontMemory memory;
  };

  std::vector<Module> modules_;
};

}  // namespace holdfast::sim
