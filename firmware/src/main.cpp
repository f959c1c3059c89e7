// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The program of a module: a port, the agent around it, for ever.
#include <new>

#include "firmware.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/module/module.hpp"
#include "selected_port.hpp"

extern "C" {
extern const holdfast::module::Configuration holdfast_configuration;  // From the linker script.
const holdfast::module::Status* volatile holdfast_status = nullptr;
volatile holdfast::firmware::Stop holdfast_stop = holdfast::firmware::Stop::kRunning;
/// For those who take the program apart: how much of the memory the agent is.
extern const std::uint32_t holdfast_agent_bytes;
[[gnu::section(".facts"), gnu::used]] const std::uint32_t holdfast_agent_bytes =
    sizeof(holdfast::agent::Agent);
}

namespace holdfast {

namespace firmware {
namespace {

// Storage without constructors that would run before the program.
alignas(SelectedPort) std::byte port_storage[sizeof(SelectedPort)];
alignas(module::Module) std::byte module_storage[sizeof(module::Module)];
[[gnu::section(".keep")]] module::PlanMemory plans;

}  // namespace

void stop(Stop reason) {
  holdfast_stop = reason;
  for (;;) {
  }
}

}  // namespace firmware

void base::panic(const char*, const char*, int) { firmware::stop(firmware::Stop::kBrokenCheck); }

}  // namespace holdfast

extern "C" [[noreturn]] void holdfast_main();

void holdfast_main() {
  using namespace holdfast;
  if (!module::is_valid(holdfast_configuration)) {
    firmware::stop(firmware::Stop::kNoConfiguration);
  }
  auto& port = *new (firmware::port_storage) firmware::SelectedPort();
  auto& module =
      *new (firmware::module_storage) module::Module(holdfast_configuration, firmware::plans, port);
  holdfast_status = &module.status();
  for (;;) {
    module.run_once();
  }
}
