// SPDX-License-Identifier: Apache-2.0
#include "output/picture/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <string>

#include "output/file.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

png_image description(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  return png;
}

[[noreturn]] void fail(png_image& png, const std::filesystem::path& path) {
  const std::string text = fmt::format("{}: {}", path.string(), png.message);
  png_image_free(&png);
  throw IoError(text);
}

}  // namespace

void write_png(const Image& image, const std::filesystem::path& path) {
  png_image png = description(image);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) fail(png, path);
  bytes.resize(size);
  replace_file(path, bytes);
}

Image read_png(const std::filesystem::path& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, path.c_str())) fail(png, path);
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  if (!png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr)) fail(png, path);
  return image;
}

}  // namespace moraine
