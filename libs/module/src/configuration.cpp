// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/configuration.hpp"

namespace holdfast::module {
namespace {

constexpr std::uint16_t kIdentityStart = 0xffff;

template <class Value>
std::span<const std::uint8_t> bytes_of(const Value& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof(Value)};
}

}  // namespace

std::span<const std::uint8_t> setup_bytes(const Configuration& configuration) {
  return bytes_of(configuration.setup).first(kSetupBytes);
}

std::uint16_t sum_of_setup(std::span<const std::uint8_t> setup_bytes) {
  return agent::wire::checksum(setup_bytes, kIdentityStart);
}

std::uint32_t checksum_of(const Configuration& configuration) {
  const auto start = static_cast<std::uint16_t>(kIdentityStart ^ configuration.revision);
  return agent::wire::checksum(setup_bytes(configuration),
                               agent::wire::checksum(bytes_of(configuration.identity), start));
}

bool is_valid(const Configuration& configuration) {
  return configuration.magic == kConfigurationMagic &&
         configuration.version == kConfigurationVersion &&
         configuration.checksum == checksum_of(configuration);
}

}  // namespace holdfast::module
