// SPDX-License-Identifier: Apache-2.0
#include "output/picture/palette.hpp"

#include <cmath>
#include <iterator>

namespace moraine {
namespace {

constexpr Rgb kChosen[] = {{70, 126, 186},  {230, 145, 56},  {92, 165, 92},   {204, 86, 86},  {146, 113, 182},
                           {238, 203, 84},  {84, 184, 184},  {217, 130, 176}, {150, 117, 88}, {140, 189, 72},
                           {105, 110, 168}, {235, 170, 140}, {60, 135, 120},  {176, 176, 168}};

/// Hue in turns, saturation and value 0 .. 1.
Rgb from_hsv(double hue, double saturation, double value) {
  Rgb rgb;
  for (int channel = 0; channel < 3; ++channel) {
    const double k = std::fmod(5.0 - 2.0 * channel + 6.0 * hue, 6.0);
    const double dip = std::fmax(0.0, std::fmin(std::fmin(k, 4.0 - k), 1.0));
    rgb[channel] = static_cast<std::uint8_t>(std::lround(255 * value * (1 - saturation * dip)));
  }
  return rgb;
}

}  // namespace

Rgb palette(std::uint32_t number) {
  constexpr std::uint32_t chosen = std::size(kChosen);
  constexpr double golden = 0.618033988749895;
  if (number < chosen) return kChosen[number];
  const std::uint32_t further = number - chosen;
  return from_hsv(std::fmod(0.08 + golden * further, 1.0), 0.55, further % 2 ? 0.68 : 0.86);
}

}  // namespace moraine
