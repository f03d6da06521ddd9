# One libFuzzer program a file of tests/fuzz; the target `fuzzers` builds them all. Run, for a minute:
#   build/fuzz/fuzz_scene_reader -max_total_time=60 -timeout=5 CORPUS assets/scenes
add_custom_target(fuzzers)
file(GLOB fuzz_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/fuzz/*.cpp)
foreach(source ${fuzz_sources})
  get_filename_component(name ${source} NAME_WE)
  add_executable(fuzz_${name} ${source})
  target_link_libraries(fuzz_${name} PRIVATE weft_scene)
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzzers fuzz_${name})
endforeach()
