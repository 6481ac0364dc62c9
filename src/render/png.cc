// Pictures as PNG, by libpng, into memory.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/png.h"

#include <png.h>

#include <csetjmp>
#include <new>
#include <string>

#include "base/error.h"

namespace tw {

namespace {

struct Encoder {
  std::vector<std::uint8_t> bytes;
  std::string error;
};

// libpng calls this instead of printing; it must not return
void on_error(png_structp png, png_const_charp message) {
  static_cast<Encoder*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = static_cast<Encoder*>(png_get_io_ptr(png))->bytes;
  bool appended = true;
  // an exception must not fly through C
  try {
    bytes.insert(bytes.end(), data, data + size);
  } catch (const std::bad_alloc&) {
    appended = false;
  }
  if (!appended) png_error(png, "out of memory");
}

void flush(png_structp) {}

// Nothing here has a destructor, which longjmp would skip.
bool write_all(png_structp png, png_infop info, Encoder* encoder, const Image* image) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, encoder, append, flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image->width),
               static_cast<png_uint_32>(image->height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 2);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  for (int y = 0; y < image->height; ++y) png_write_row(png, image->pixel(0, y));
  png_write_end(png, info);
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  Encoder encoder;
  encoder.bytes.reserve(image.rgb.size() / 2);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool written = info && write_all(png, info, &encoder, &image);
  png_destroy_write_struct(&png, &info);
  if (!written) throw UserError("cannot encode the picture as PNG: " + encoder.error);
  return std::move(encoder.bytes);
}

}  // namespace tw
