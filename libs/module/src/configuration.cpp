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

std::uint32_t checksum_of(const Configuration& configuration) {
  return agent::wire::checksum(
      bytes_of(configuration.setup).first(kSetupBytes),
      agent::wire::checksum(bytes_of(configuration.identity), kIdentityStart));
}

bool is_valid(const Configuration& configuration) {
  return configuration.magic == kConfigurationMagic &&
         configuration.version == kConfigurationVersion &&
         configuration.checksum == checksum_of(configuration);
}

}  // namespace holdfast::module
