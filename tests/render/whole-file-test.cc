// Files are whole or not there; PNG files hold the picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/whole-file.h"

#include <png.h>

#include <fstream>

#include "picture-tools.h"
#include "render/png.h"

namespace tw::test {
namespace {

namespace fs = std::filesystem;

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const std::vector<std::uint8_t> abc = {'a', 'b', 'c'};

TEST(WholeFile, it_holds_the_bytes_and_no_part_remains) {
  const TemporaryFolder folder;
  write_whole_file(folder / "x", abc);
  write_whole_file(folder / "x", abc);
  EXPECT_EQ(read_file(folder / "x"), "abc");
  EXPECT_FALSE(fs::exists(folder / "x.part"));
}

TEST(WholeFile, a_full_disk_is_an_error_that_names_the_file) {
  EXPECT_TRUE(contains(user_error_of([] { write_whole_file("/dev/full", abc); }),
                       "cannot write '/dev/full': No space left on device"));
  // the device is still there
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(WholeFile, after_an_error_the_part_is_gone_and_the_old_file_remains) {
  const TemporaryFolder folder;
  write_whole_file(folder / "x", abc);
  // renaming cannot replace a folder; writing cannot enter one that is missing
  fs::create_directory(folder / "d");
  EXPECT_NE(user_error_of([&] { write_whole_file(folder / "d", abc); }), "");
  EXPECT_TRUE(contains(user_error_of([&] { write_whole_file(folder / "no/x", abc); }),
                       "No such file or directory"));
  EXPECT_EQ(read_file(folder / "x"), "abc");
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_NE(entry.path().extension(), ".part");
}

TEST(WholeFile, folders_are_made_or_refused_with_the_reason) {
  const TemporaryFolder folder;
  make_writable_folder(folder / "a/b/c");
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
  make_writable_folder("");
  write_whole_file(folder / "file", abc);
  EXPECT_TRUE(contains(user_error_of([&] { make_writable_folder(folder / "file/x"); }),
                       "cannot make the folder"));
  EXPECT_NE(user_error_of([&] { make_writable_folder(folder / "file"); }), "");
  EXPECT_NE(user_error_of([] { make_writable_folder("/proc/timewarp"); }), "");
}

TEST(Png, decoding_gives_the_picture_back) {
  Image image{37, 11, {}};
  for (int i = 0; i < 3 * 37 * 11; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * i / 7));
  const std::vector<std::uint8_t> bytes = encode_png(image);
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()));
  EXPECT_EQ(reader.width, 37u);
  EXPECT_EQ(reader.height, 11u);
  reader.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(image.rgb.size());
  ASSERT_TRUE(png_image_finish_read(&reader, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, image.rgb);
}

}  // namespace
}  // namespace tw::test
