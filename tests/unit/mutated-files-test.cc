// Robots and meshes with a few bytes wrong: each loads or is refused with a message.
//
// MUTATIONS=10000 tries so many of each file; MUTATED=FILE:FILE others than ours, whose meshes lie
// beside them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "base/random.h"
#include "import/solid-file.h"
#include "import/surface-file.h"
#include "import/texture-file.h"
#include "import/urdf.h"
#include "support/temporary-folder.h"

namespace tw::test {
namespace {

namespace fs = std::filesystem;

const char* const robot = R"(<?xml version="1.0"?>
<robot name="bot">
  <material name="red"><color rgba="1 0 0 1"/></material>
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="arm">
    <inertial><origin xyz="0.1 0 0" rpy="0 0 1"/><mass value="2"/>
      <inertia ixx="0.02" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.1"/><geometry><mesh filename="a.obj" scale="1 2 1"/></geometry>
      <material name="red"/></visual>
    <collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision>
  </link>
  <joint name="j" type="revolute">
    <parent link="base"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="10" velocity="1"/><dynamics damping="0.1" friction="0.2"/>
  </joint>
  <link name="hand"><inertial><mass value="1"/></inertial>
    <collision><geometry><mesh filename="package://p/a.stl"/></geometry></collision></link>
  <joint name="k" type="prismatic">
    <parent link="arm"/><child link="hand"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1"/><mimic joint="j" multiplier="0.5" offset="0.1"/>
  </joint>
  <link name="tool"/>
  <joint name="l" type="planar"><parent link="hand"/><child link="tool"/></joint>
</robot>
)";

const char* const object = R"(mtllib a.mtl
o one
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vn 0 0 -1
usemtl paint
f 1//1 3//1 2//1
f 1 2 4
f 2 3 4
f 3 1 4
o two
v 5 0 0
v 6 0 0
v 5 1 0
v 5 0 1
f -4 -2 -3
f -4 -3 -1
f -3 -2 -1
f -2 -4 -1
)";

const char* const solid = R"(solid tip
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 1 0
vertex 1 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 0 1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid tip
)";

const char* const collada = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert>
<diffuse><color>1 0.5 0 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4" material="s"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>
)";

// A PNG of one red pixel.
std::string picture() {
  static constexpr unsigned char bytes[] = {
      0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n', 0,   0,    0,    13,   'I',  'H',
      'D',  'R',  0,    0,    0,    1,    0,    0,    0,   1,    8,    2,    0,    0,
      0,    0x90, 0x77, 0x53, 0xde, 0,    0,    0,    12,  'I',  'D',  'A',  'T',  0x78,
      0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0,    0,    3,    1,   1,    0,    0xc9, 0xfe, 0x92,
      0xef, 0,    0,    0,    0,    'I',  'E',  'N',  'D', 0xae, 0x42, 0x60, 0x82};
  return std::string(reinterpret_cast<const char*>(bytes), sizeof bytes);
}

std::string mutated(std::string text, Random& random) {
  for (std::uint64_t times = 1 + random.below(2); times > 0 && !text.empty(); --times) {
    const std::size_t at = random.below(text.size()), length = 1 + random.below(40);
    switch (random.below(5)) {
      case 0: text[at] = static_cast<char>(random.below(256)); break;
      case 1: text[at] = "0123456789.-eE <>\"/#"[random.below(20)]; break;
      case 2: text.erase(at, length); break;
      case 3: text.insert(at, text.substr(at, length)); break;
      default: text.insert(at, text.substr(random.below(text.size()), length));
    }
  }
  return text;
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// Whether it loads.
bool loads(const std::function<void()>& load) {
  try {
    load();
    return true;
  } catch (const UserError&) {
    return false;
  }
}

// As a robot, or in the ways in which meshes are read.
int load(const std::string& file) {
  Mending mending(false);
  if (file.ends_with(".urdf"))
    return loads([&] {
             read_urdf(file, {UrdfBase::automatic, {}}, mending);
           }) +
           loads([&] {
             read_urdf(file, {UrdfBase::free, {}}, mending);
           });
  if (file.ends_with(".png")) return loads([&] { read_texture(file, 2048); });
  SolidOptions hulls;
  hulls.hulls = true;
  return loads([&] { read_solid(file, hulls, mending); }) +
         loads([&] { read_surface(file, Vec3::Ones(), false, mending); });
}

TEST(MutatedFiles, load_or_are_refused) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "p");
  const auto put = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  };
  put("a.mtl", "newmtl paint\nKd 1 0 0\nmap_Kd a.png\n");
  put("a.png", picture());
  put("p/a.stl", solid);
  std::vector<fs::path> files{put("a.urdf", robot), put("a.obj", object), put("a.stl", solid),
                              put("a.dae", collada), folder / "a.png"};
  if (const char* given = std::getenv("MUTATED")) {
    files.clear();
    std::istringstream names(given);
    for (std::string name; std::getline(names, name, ':');) files.emplace_back(name);
  }
  const char* many = std::getenv("MUTATIONS");
  const int count = many ? std::atoi(many) : 100;
  Random random(7);
  for (const fs::path& file : files) {
    const std::string text = text_of(file);
    const int ways = file.extension() == ".png" ? 1 : 2;
    EXPECT_EQ(load(file.string()), ways) << file;
    int loaded = 0;
    const fs::path trial = file.parent_path() / ("mutated" + file.extension().string());
    for (int i = 0; i < count; ++i) {
      std::ofstream(trial, std::ios::binary) << mutated(text, random);
      loaded += load(trial.string());
    }
    fs::remove(trial);
    EXPECT_LT(loaded, ways * count) << file;
  }
}

}  // namespace
}  // namespace tw::test
