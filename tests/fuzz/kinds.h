// The kinds of random scenes, one procedure each: it fills a draft.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw::fuzz {

class Draft;

// kinds-poured.cc
void draw_heap(Draft& draft);
void draw_round(Draft& draft);
void draw_rolls(Draft& draft);
void draw_flush(Draft& draft);
void draw_thin(Draft& draft);
void draw_spin(Draft& draft);
void draw_piston(Draft& draft);
void draw_drum(Draft& draft);
void draw_shaker(Draft& draft);

// kinds-built.cc
void draw_lattice(Draft& draft);
void draw_stack(Draft& draft);
void draw_arch(Draft& draft);
void draw_cards(Draft& draft);

// kinds-thrown.cc
void draw_bullet(Draft& draft);
void draw_seam(Draft& draft);
void draw_groove(Draft& draft);
void draw_plates(Draft& draft);
void draw_corner(Draft& draft);
void draw_ramp(Draft& draft);
void draw_hills(Draft& draft);
void draw_meshes(Draft& draft);

// kinds-joined.cc
void draw_chains(Draft& draft);
void draw_bonds(Draft& draft);
void draw_called(Draft& draft);
void draw_tools(Draft& draft);
void draw_sensed(Draft& draft);

// kinds-asked.cc
void draw_asked(Draft& draft);
void draw_driven(Draft& draft);

// kinds-loaded.cc
void draw_struck(Draft& draft);
void draw_pressed(Draft& draft);
void draw_rested(Draft& draft);

}  // namespace tw::fuzz
