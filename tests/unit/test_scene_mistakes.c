/* Mistakes in a scene file: one scene a mistake, each of which differs from a good one in that mistake alone, stands on a line
 * of its own, and must give VIT_BAD_INPUT and exactly "file:line: ... what". */
#define FOLDER VIT_BUILD_DIR "/tests/unit/scene_mistakes_files"
#include "scene_file_lab.h"

#define REFUSES(name, line, what, text)                                                                                        \
    static void name(void **state) {                                                                                           \
        (void)state;                                                                                                           \
        refuse(text, line, what);                                                                                              \
    }

REFUSES(an_empty_file_is_refused, 0, "'meshes'", "")
REFUSES(a_scene_without_meshes_is_refused, 0, "'meshes'", CAMERA)
REFUSES(an_empty_list_of_meshes_is_refused, 1, "at least one mesh", "meshes = ( );\n" CAMERA)
REFUSES(a_mesh_without_a_file_is_refused, 2, "mesh 1: needs a 'file'", "meshes = (\n{ scale = 2.0; } );\n" CAMERA)
REFUSES(a_mesh_of_scale_0_is_refused, 1, "mesh 1: 'scale'", "meshes = ( { file = \"a\"; scale = 0; } );\n" CAMERA)
REFUSES(a_mesh_of_infinite_scale_is_refused, 1, "mesh 1: 'scale'", "meshes = ( { file = \"a\"; scale = 1e999; } );\n" CAMERA)
REFUSES(a_mesh_that_is_no_group_is_refused, 1, "mesh 1: must be a group", "meshes = ( \"a.obj\" );\n" CAMERA)
REFUSES(meshes_that_are_no_list_are_refused, 1, "must be a list of groups", "meshes = { file = \"a.obj\"; };\n" CAMERA)
REFUSES(an_unknown_setting_is_refused, 3, "unknown setting 'ligths'; there are 'lights', ", GOOD "ligths = ( );\n")
REFUSES(an_unknown_setting_of_a_group_is_refused, 3, "output: unknown setting 'widht'", GOOD "output: { widht = 640; };\n")
REFUSES(an_unknown_setting_of_a_key_is_refused, 4, "light 1, key 1: unknown setting 'colour'",
        GOOD "lights = ( { type = \"point\"; keys = (\n{ colour = (1, 1, 1); } ); } );\n")
REFUSES(a_setting_given_twice_is_refused, 3, "duplicate", GOOD "camera = 1;\n")
REFUSES(text_that_is_no_scene_is_refused, 3, "syntax error", GOOD "hello, world\n")
REFUSES(a_width_of_0_is_refused, 3, "'width' must be in [1, 7680], got 0", GOOD "output: { width = 0; };\n")
REFUSES(a_height_of_4321_is_refused, 3, "'height' must be in [1, 4320], got 4321", GOOD "output: { height = 4321; };\n")
REFUSES(a_width_beyond_32_bits_is_refused, 3, "'width'", GOOD "output: { width = 4294967297L; };\n")
REFUSES(a_width_that_32_bits_would_wrap_is_refused, 3, "'4294967456' is beyond 32 bits",
        GOOD "output: { width = 4294967456; };\n")
REFUSES(a_width_that_64_bits_would_wrap_is_refused, 3, "is beyond 64 bits",
        GOOD "output: { width = 18446744073709551776L; };\n")
REFUSES(a_negative_number_beyond_32_bits_is_refused, 4, "'-2147483649' is beyond", GOOD "output: {\nwidth = -2147483649; };\n")
REFUSES(frames_beyond_32_bits_are_refused, 3, "'4294967298' is beyond", GOOD "output: { frames=4294967298; };\n")
REFUSES(a_vector_beyond_32_bits_is_refused, 3, "'4294967297' is beyond", GOOD "background = (0, 0, 4294967297);\n")
REFUSES(an_octal_number_is_refused, 3, "'010' begins with 0", GOOD "output: { frames = 010; };\n")
REFUSES(an_octal_number_of_64_bits_is_refused, 3, "'+010L' begins with 0", GOOD "output: { frames = +010L; };\n")
REFUSES(a_hexadecimal_number_is_refused, 3, "'0x10' numbers are decimal", GOOD "output: { frames = 0x10; };\n")
REFUSES(a_binary_number_is_refused, 3, "'0b10' numbers are decimal", GOOD "output: { frames = 0b10; };\n")
REFUSES(a_choice_beyond_32_bits_is_refused, 3, "'indirect_samples'", GOOD "quality: { indirect_samples = 4294967300L; };\n")
REFUSES(a_comma_behind_the_last_light_is_refused, 4, "',' has nothing behind it",
        GOOD "lights = ( { type = \"point\"; " KEYS "}\n, // last\n/* ) */ );\n")
REFUSES(a_comma_behind_the_last_number_is_refused, 3, "',' has nothing behind it", GOOD "background = [0.0, 0.0, 0.0,];\n")
REFUSES(utf_16_is_refused, 1, "UTF-8", "\xff\xfem")
REFUSES(a_width_that_is_no_whole_number_is_refused, 3, "whole number", GOOD "output: { width = 640.5; };\n")
REFUSES(no_frames_are_refused, 3, "'frames'", GOOD "output: { frames = 0; };\n")
REFUSES(an_fps_of_0_is_refused, 3, "'fps' must be in (0, 1000], got 0", GOOD "output: { fps = 0; };\n")
REFUSES(a_background_of_two_numbers_is_refused, 3, "'background' must be three numbers", GOOD "background = [0.0, 0.0];\n")
REFUSES(a_negative_background_is_refused, 3, "'background'", GOOD "background = (0, -1, 0);\n")
REFUSES(an_array_of_mixed_numbers_is_refused_with_advice, 3, "write [0.0, 1.0, 0.5]", GOOD "background = [0, 1.0, 0];\n")
REFUSES(a_scene_without_a_camera_is_refused, 0, "there is no 'camera'", MESH)
REFUSES(a_camera_without_keys_is_refused, 2, "camera: needs either 'keys' or 'use'", MESH "camera: { near = 1; };\n")
REFUSES(a_camera_with_keys_and_a_name_is_refused, 2, "camera: needs either 'keys' or 'use'",
        MESH "camera: { use = \"c\"; keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n")
REFUSES(a_first_key_without_an_eye_is_refused, 2, "camera key 1: the first key needs 'eye'",
        MESH "camera: { keys = ( { target = (0, 0, 0); } ); };\n")
REFUSES(a_field_of_view_of_170_degrees_is_refused, 2, "camera key 1: 'fov' must be in (1, 170), got 170",
        MESH "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); fov = 170; } ); };\n")
REFUSES(an_eye_at_its_target_is_refused, 2, "same point",
        MESH "camera: { keys = ( { eye = (1, 2, 3); target = (1, 2, 3); } ); };\n")
REFUSES(an_up_along_the_view_is_refused, 2, "'up' is zero or parallel",
        MESH "camera: { keys = ( { eye = (0, 3, 0); target = (0, 0, 0); } ); };\n")
REFUSES(camera_keys_out_of_order_are_refused, 3, "camera key 2: 'time' must be after",
        MESH "camera: { keys = ( { time = 2; eye = (0, 1, 3); target = (0, 1, 0); },\n{ time = 1; } ); };\n")
REFUSES(a_key_without_a_time_is_refused, 3, "camera key 2: 'time' must be after",
        MESH "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); },\n{ fov = 30; } ); };\n")
REFUSES(an_exposure_of_0_is_refused, 2, "camera: 'exposure'", MESH "camera: { use = \"c\"; exposure = 0; };\n")
REFUSES(a_light_with_a_cone_of_270_degrees_is_refused_with_its_line, 4, "light 2: 'outer' must be in (0, 90], got 270",
        GOOD "lights = ( { type = \"point\"; " KEYS "},\n{ type = \"spot\"; outer = 270; " SPOT "} );\n")
REFUSES(an_inner_cone_outside_the_outer_is_refused, 3, "light 1: 'inner' (60)",
        GOOD "lights = ( { type = \"spot\"; inner = 60; outer = 40; " SPOT "} );\n")
REFUSES(a_light_without_a_type_is_refused, 3, "light 1: needs a 'type'", GOOD "lights = ( { " KEYS "} );\n")
REFUSES(a_light_of_unknown_type_is_refused, 3, "'type' must be \"point\", \"spot\" or \"directional\", got \"sun\"",
        GOOD "lights = ( { type = \"sun\"; " KEYS "} );\n")
REFUSES(a_light_without_keys_is_refused, 3, "light 1: needs either", GOOD "lights = ( { type = \"point\"; } );\n")
REFUSES(a_spot_light_without_a_target_is_refused, 3, "needs a 'target'", GOOD "lights = ( { type = \"spot\"; " KEYS "} );\n")
REFUSES(a_point_light_with_a_target_is_refused, 3, "'target' is for spot and directional lights",
        GOOD "lights = ( { type = \"point\"; " SPOT "} );\n")
REFUSES(a_point_light_with_a_cone_is_refused, 3, "for spot lights",
        GOOD "lights = ( { type = \"point\"; outer = 20; " KEYS "} );\n")
REFUSES(a_window_without_a_range_is_refused, 3, "needs a 'range'",
        GOOD "lights = ( { type = \"point\"; falloff = \"window\"; " KEYS "} );\n")
REFUSES(a_negative_power_is_refused, 3, "light 1, key 1: 'power'",
        GOOD "lights = ( { type = \"point\"; keys = ( { position = (0, 1, 0); power = (1, -1, 1); } ); } );\n")
REFUSES(a_position_that_is_text_is_refused, 3, "'position' must be three numbers",
        GOOD "lights = ( { type = \"point\"; keys = ( { position = (\"a\", 0, 0); power = (1, 1, 1); } ); } );\n")
REFUSES(photons_that_are_no_truth_value_are_refused, 3, "'photons' must be true or false",
        GOOD "lights = ( { type = \"point\"; photons = 1; " KEYS "} );\n")
REFUSES(a_material_without_a_name_is_refused, 3, "material 1: needs a 'name'", GOOD "materials = ( { cutoff = 0.5; } );\n")
REFUSES(a_material_given_twice_is_refused, 4, "material 2: 'a' was already given",
        GOOD "materials = ( { name = \"a\"; },\n{ name = \"a\"; } );\n")
REFUSES(a_reflectance_above_1_is_refused, 3, "'color' must have its numbers in [0, 1], got 1.5",
        GOOD "materials = ( { name = \"a\"; color = (1.5, 0, 0); } );\n")
REFUSES(a_million_and_one_photons_are_refused, 3, "quality: 'photons'", GOOD "quality: { photons = 1000001; };\n")
REFUSES(zero_bounces_are_refused, 3, "quality: 'bounces' must be in [1, 32], got 0", GOOD "quality: { bounces = 0; };\n")
REFUSES(a_tile_of_24_pixels_is_refused, 3, "'tile' must be 8, 16, 32 or 64, got 24", GOOD "quality: { tile = 24; };\n")
REFUSES(one_sample_in_2_is_refused, 3, "'indirect_samples' must be 1, 4 or 16, got 2",
        GOOD "quality: { indirect_samples = 2; };\n")
REFUSES(an_unknown_filter_is_refused, 3, "'texture_filter' must be \"nearest\", \"bilinear\" or \"trilinear\", got \"cubic\"",
        GOOD "quality: { texture_filter = \"cubic\"; };\n")
REFUSES(a_filter_that_is_a_number_is_refused, 3, "'texture_filter' must be \"nearest\"",
        GOOD "quality: { texture_filter = 2; };\n")
REFUSES(vertices_of_17_bits_are_refused, 3, "'vertex_bits' must be 32 or 16, got 17", GOOD "quality: { vertex_bits = 17; };\n")
REFUSES(samples_of_8_bits_are_refused, 3, "'sample_bits' must be 32 or 16, got 8", GOOD "quality: { sample_bits = 8; };\n")
REFUSES(normals_of_a_word_are_refused, 3, "'normal_bits' must be 16 or 8", GOOD "quality: { normal_bits = \"few\"; };\n")
REFUSES(one_sample_in_none_is_refused, 3, "'indirect_samples'", GOOD "quality: { indirect_samples = 0; };\n")
REFUSES(a_radius_that_is_a_word_is_refused, 3, "or \"auto\"", GOOD "quality: { radius = \"big\"; };\n")
REFUSES(raw_lists_are_refused, 3, "needs estimate \"buckets\"", GOOD "quality: { smoothing = \"raw\"; };\n")
REFUSES(light_zones_without_zones_are_refused, 3, "needs zones", GOOD "quality: { light_zones = true; };\n")
REFUSES(a_flattening_of_a_sphere_is_refused, 3, "needs kernel", GOOD "quality: { flatten = 3; };\n")
REFUSES(an_error_with_a_line_feed_in_it_stays_one_line, 3, "got \"a?b\"", GOOD "lights = ( { type = \"a\\nb\"; " KEYS "} );\n")

int main(void) {
    static const struct CMUnitTest tests[] = {
        T(an_empty_file_is_refused),
        T(a_scene_without_meshes_is_refused),
        T(an_empty_list_of_meshes_is_refused),
        T(a_mesh_without_a_file_is_refused),
        T(a_mesh_of_scale_0_is_refused),
        T(a_mesh_of_infinite_scale_is_refused),
        T(a_mesh_that_is_no_group_is_refused),
        T(meshes_that_are_no_list_are_refused),
        T(an_unknown_setting_is_refused),
        T(an_unknown_setting_of_a_group_is_refused),
        T(an_unknown_setting_of_a_key_is_refused),
        T(a_setting_given_twice_is_refused),
        T(text_that_is_no_scene_is_refused),
        T(a_width_of_0_is_refused),
        T(a_height_of_4321_is_refused),
        T(a_width_beyond_32_bits_is_refused),
        T(a_width_that_32_bits_would_wrap_is_refused),
        T(a_width_that_64_bits_would_wrap_is_refused),
        T(a_negative_number_beyond_32_bits_is_refused),
        T(frames_beyond_32_bits_are_refused),
        T(a_vector_beyond_32_bits_is_refused),
        T(an_octal_number_is_refused),
        T(an_octal_number_of_64_bits_is_refused),
        T(a_hexadecimal_number_is_refused),
        T(a_binary_number_is_refused),
        T(a_choice_beyond_32_bits_is_refused),
        T(a_comma_behind_the_last_light_is_refused),
        T(a_comma_behind_the_last_number_is_refused),
        T(utf_16_is_refused),
        T(a_width_that_is_no_whole_number_is_refused),
        T(no_frames_are_refused),
        T(an_fps_of_0_is_refused),
        T(a_background_of_two_numbers_is_refused),
        T(a_negative_background_is_refused),
        T(an_array_of_mixed_numbers_is_refused_with_advice),
        T(a_scene_without_a_camera_is_refused),
        T(a_camera_without_keys_is_refused),
        T(a_camera_with_keys_and_a_name_is_refused),
        T(a_first_key_without_an_eye_is_refused),
        T(a_field_of_view_of_170_degrees_is_refused),
        T(an_eye_at_its_target_is_refused),
        T(an_up_along_the_view_is_refused),
        T(camera_keys_out_of_order_are_refused),
        T(a_key_without_a_time_is_refused),
        T(an_exposure_of_0_is_refused),
        T(a_light_with_a_cone_of_270_degrees_is_refused_with_its_line),
        T(an_inner_cone_outside_the_outer_is_refused),
        T(a_light_without_a_type_is_refused),
        T(a_light_of_unknown_type_is_refused),
        T(a_light_without_keys_is_refused),
        T(a_spot_light_without_a_target_is_refused),
        T(a_point_light_with_a_target_is_refused),
        T(a_point_light_with_a_cone_is_refused),
        T(a_window_without_a_range_is_refused),
        T(a_negative_power_is_refused),
        T(a_position_that_is_text_is_refused),
        T(photons_that_are_no_truth_value_are_refused),
        T(a_material_without_a_name_is_refused),
        T(a_material_given_twice_is_refused),
        T(a_reflectance_above_1_is_refused),
        T(a_million_and_one_photons_are_refused),
        T(zero_bounces_are_refused),
        T(a_tile_of_24_pixels_is_refused),
        T(one_sample_in_2_is_refused),
        T(one_sample_in_none_is_refused),
        T(vertices_of_17_bits_are_refused),
        T(samples_of_8_bits_are_refused),
        T(normals_of_a_word_are_refused),
        T(an_unknown_filter_is_refused),
        T(a_filter_that_is_a_number_is_refused),
        T(a_radius_that_is_a_word_is_refused),
        T(raw_lists_are_refused),
        T(light_zones_without_zones_are_refused),
        T(a_flattening_of_a_sphere_is_refused),
        T(an_error_with_a_line_feed_in_it_stays_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
