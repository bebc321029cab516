// SPDX-License-Identifier: GPL-3.0-or-later
#include <png.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/render.h>

namespace eigencrust {
namespace {

bool consistent(const Image& image) {
  return image.width > 0 && image.height > 0 && image.rgb.size() == std::size_t{3} * image.width * image.height;
}

} // namespace

Image beside(const std::vector<Image>& images) {
  Image result;
  std::uint64_t width = 0;
  for (const Image& image : images) {
    if (!consistent(image) || image.height != images[0].height)
      throw Error(ErrorKind::usage, "beside", "the pictures are not of one height", "render them with equal heights");
    width += image.width;
  }
  if (width > std::numeric_limits<std::int32_t>::max())
    throw Error(ErrorKind::usage, "beside", "the pictures are too wide together", "take fewer or smaller ones");
  if (images.empty()) return result;
  result.width = static_cast<std::uint32_t>(width);
  result.height = images[0].height;
  result.rgb.reserve(std::size_t{3} * result.width * result.height);
  for (std::size_t row = 0; row < result.height; ++row)
    for (const Image& image : images) {
      const auto begin = image.rgb.begin() + static_cast<std::ptrdiff_t>(row * 3 * image.width);
      result.rgb.insert(result.rgb.end(), begin, begin + static_cast<std::ptrdiff_t>(3 * image.width));
    }
  return result;
}

Image stacked(const std::vector<Image>& images) {
  Image result;
  std::uint64_t height = 0;
  for (const Image& image : images) {
    if (!consistent(image) || image.width != images[0].width)
      throw Error(ErrorKind::usage, "stacked", "the pictures are not of one width", "render them with equal widths");
    height += image.height;
  }
  if (height > std::numeric_limits<std::int32_t>::max())
    throw Error(ErrorKind::usage, "stacked", "the pictures are too high together", "take fewer or smaller ones");
  if (images.empty()) return result;
  result.width = images[0].width;
  result.height = static_cast<std::uint32_t>(height);
  for (const Image& image : images) result.rgb.insert(result.rgb.end(), image.rgb.begin(), image.rgb.end());
  return result;
}

// The simplified interface of libpng reports errors by return value: no longjmp.
std::vector<std::byte> encode_png(const Image& image) {
  if (!consistent(image))
    throw Error(ErrorKind::input, "picture", "the picture is empty or its rows do not fit its size", "render it first");
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0)
    throw Error(ErrorKind::input, "picture", std::string("the picture could not be encoded: ") + png.message,
                "choose a smaller picture");
  bytes.resize(size);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::byte> bytes = encode_png(image);
  write_file_atomically(path, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  });
}

} // namespace eigencrust
