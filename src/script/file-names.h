// File names at the border: a name reaches the system as exactly the bytes that the user gave.
//
// File names are bytes, Scheme strings are characters.  The program works in UTF-8
// (script/locale.h), so nearly every name is text and both are the same.  A byte of an argument
// that is not UTF-8 becomes a character for private use, U+10FE00 plus the byte, which
// `to_file_name` turns back: the way there and back is one-to-one, as characters of that range are
// themselves taken byte by byte.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <string>
#include <string_view>

namespace tw {

// UTF-8 that stands for any bytes: those that are UTF-8 stay as they are.
std::string text_of_bytes(std::string_view bytes);
// The inverse of text_of_bytes.
std::string bytes_of_text(std::string_view text);

// An argument of the command line as a Scheme string.
SCM from_argument(const char* bytes);
// The bytes of a file name.  Throws BadValue for what is not a string; never longjmps.
std::string to_file_name(SCM value, const char* name);

}  // namespace tw
