// File names at the border: bytes there, characters here.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/file-names.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include "script/primitive.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_file_names)

namespace {

// bytes 80 to FF stand at U+10FE80 to U+10FEFF
constexpr char32_t escape_base = 0x10FE00;

bool is_escape(char32_t c) { return c >= escape_base + 0x80 && c <= escape_base + 0xFF; }

struct Decoded {
  char32_t character = 0;
  std::size_t length = 0;  // 0: no character begins here
};

// The character at the beginning of `bytes`, which is not empty: the shortest form only, no
// surrogates, up to U+10FFFF.
Decoded decode(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || bytes.size() < length) return {};
  char32_t c = lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    c = c << 6 | (byte(i) & 0x3F);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (c < least[length] || c > 0x10FFFF || (c >= 0xD800 && c <= 0xDFFF)) return {};
  return {c, length};
}

void append_escape(std::string& text, unsigned char byte) {
  const char32_t c = escape_base + byte;
  for (const int shift : {18, 12, 6, 0})
    text += static_cast<char>(shift == 18 ? 0xF0 | c >> 18 : 0x80 | (c >> shift & 0x3F));
}

}  // namespace

std::string text_of_bytes(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const auto [character, length] = decode(bytes);
    if (length == 0 || is_escape(character)) {
      append_escape(text, static_cast<unsigned char>(bytes.front()));
      bytes.remove_prefix(1);
    } else {
      text.append(bytes.substr(0, length));
      bytes.remove_prefix(length);
    }
  }
  return text;
}

std::string bytes_of_text(std::string_view text) {
  std::string bytes;
  while (!text.empty()) {
    const auto [character, length] = decode(text);
    const std::size_t step = length ? length : 1;
    if (is_escape(character))
      bytes += static_cast<char>(character - escape_base);
    else
      bytes.append(text.substr(0, step));
    text.remove_prefix(step);
  }
  return bytes;
}

SCM from_argument(const char* bytes) { return from_string(text_of_bytes(bytes)); }

std::string to_file_name(SCM value, const char* name) {
  std::string bytes = bytes_of_text(to_string(value, name));
  if (bytes.find('\0') != std::string::npos)
    throw BadValue{name, value, "a file name, without a null character"};
  return bytes;
}

// Guile's own procedures cannot name a file whose name is not UTF-8.
TW_PRIMITIVE(open_scene, "%open-scene", (SCM path),
             "Open the file of a scene; return its descriptor.") {
  const std::string name = to_file_name(path, "the scene");
  const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    throw UserError("cannot read the scene " + name + ": " + std::strerror(errno) +
                    "; expected a Scheme file");
  return scm_from_int(file);
}

}  // namespace tw
