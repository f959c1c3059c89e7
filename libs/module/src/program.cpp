// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/program.hpp"

namespace holdfast::module {

std::uint32_t id_of(std::span<const std::uint8_t> unique_number) {
  std::uint32_t hash = 2'166'136'261U;
  for (const std::uint8_t byte : unique_number) {
    hash = (hash ^ byte) * 16'777'619U;
  }
  return hash == 0 ? 1 : hash;
}

Program::Program(Configuration& configuration, std::uint32_t id, PlanMemory& plans, Port& port)
    : configuration_(configuration),
      plans_(plans),
      configurer_(port, configuration_),
      instrument_(configurer_, configuration_) {
  if (!configurer_.is_configured()) {
    const agent::Identity own =
        has_identity(configuration_) ? configuration_.identity : agent::Identity{};
    configuration_ = Configuration{};
    configuration_.identity = own;
  }
  if (id != 0) {
    configuration_.identity.id = id;
  }
  begin();
}

void Program::begin() {
  module_.reset();
  instrument_.speak_of(nullptr);
  if (configurer_.is_configured()) {
    module_.emplace(configuration_.setup, configuration_.identity, plans_, instrument_);
    instrument_.speak_of(&*module_);
  }
}

void Program::run_once() {
  if (module_) {
    module_->run_once();
  } else {
    wait_for_configuration();
  }
  if (configurer_.take_change()) {
    begin();
  }
}

void Program::wait_for_configuration() {
  constexpr Time kBlink = Time{1} << 18U;
  Incoming incoming;
  while (instrument_.receive(incoming)) {
  }
  const bool is_dark = (instrument_.now() & kBlink) != 0;
  instrument_.show(is_dark ? agent::Colour{}
                           : agent::Colour{.red = 0, .green = 255, .blue = 255, .blinks = true});
  instrument_.wait(instrument_.now() + kBlink);
}

void Program::plan(const base::Cell& cell) {
  if (module_) {
    module_->plan(cell);
  }
}

void Program::withdraw(const base::Cell& cell) {
  if (module_) {
    module_->withdraw(cell);
  }
}

}  // namespace holdfast::module
