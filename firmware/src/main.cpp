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
[[gnu::section(".keep")]] volatile holdfast::firmware::Stop holdfast_stop;
volatile holdfast::firmware::Stop holdfast_last_stop;  ///< After a loss of power anything.
volatile std::uint32_t holdfast_reset_reason;          ///< Port::take_reset_reason()
/// How much of the memory the agent is, for those who take the program apart.
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
    SelectedPort::signal(static_cast<std::uint32_t>(reason), reason == Stop::kNoConfiguration);
  }
}

}  // namespace firmware

void base::panic(const char*, const char*, int) { firmware::stop(firmware::Stop::kBrokenCheck); }

}  // namespace holdfast

extern "C" [[noreturn]] void holdfast_main();

void holdfast_main() {
  using namespace holdfast;
  auto& port = *new (firmware::port_storage) firmware::SelectedPort();
  holdfast_reset_reason = firmware::SelectedPort::take_reset_reason();
  holdfast_last_stop = holdfast_stop;
  holdfast_stop = firmware::Stop::kRunning;
  if (!module::is_valid(holdfast_configuration)) {
    firmware::stop(firmware::Stop::kNoConfiguration);
  }
  auto& module =
      *new (firmware::module_storage) module::Module(holdfast_configuration, firmware::plans, port);
  holdfast_status = &module.status();
  for (;;) {
    module.run_once();
  }
}
