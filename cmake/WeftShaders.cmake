# Compiles every shader to SPIR-V with glslc and embeds the modules in the library weft_spirv.
file(GLOB shader_sources CONFIGURE_DEPENDS
  ${CMAKE_SOURCE_DIR}/shaders/passes/*.comp ${CMAKE_SOURCE_DIR}/shaders/draw/*.vert ${CMAKE_SOURCE_DIR}/shaders/draw/*.frag)
set(spirv_dir ${CMAKE_BINARY_DIR}/spirv)
set(spirv_files "")
set(spirv_names "")

# In double: every pass except the kernels that read texels, the compensated forms of float, and bench's copy.
set(double_sources ${shader_sources})
list(FILTER double_sources INCLUDE REGEX "/passes/")
list(FILTER double_sources EXCLUDE REGEX "(_bands|_steal|_strip|_texel|_compensated|/copy|/spread_look)\\.comp$")
list(TRANSFORM double_sources APPEND "+WEFT_F64")
list(FILTER shader_sources EXCLUDE REGEX "/present\\.comp$")  # plans in double alone have it

# What tells whether the cloth comes near a body, or a link near its limit, and what then runs. The passes of
# tearing have that always.
set(reach_sources ${shader_sources} ${double_sources})
list(FILTER reach_sources INCLUDE REGEX
  "/(integrate(_steal|_strip|_texel)?(_compensated)?|xpbd_finish|strain_limit|solid_contact|mesh_contact)\\.comp(\\+WEFT_F64)?$")
list(TRANSFORM reach_sources APPEND "+WEFT_REACH")

# What tells whether the cloth may stay spread out: in float alone.
set(spread_sources ${shader_sources})
list(FILTER spread_sources INCLUDE REGEX "/integrate(_steal|_strip|_texel)?\\.comp$")
list(TRANSFORM spread_sources APPEND "+WEFT_SPREAD")

# What reads vectors as texels where the kernel does.
set(texel_sources "")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shader_sources})  # which they are is said inside
foreach(source ${shader_sources})
  file(STRINGS ${source} vectors REGEX "^READS_VECTORS")
  if(vectors)
    list(APPEND texel_sources ${source}+WEFT_TEXELS)
  endif()
endforeach()

# Kernels that lack an effect, one constant of effects.glsl each: what bench --effects holds against those that have
# it switched off.
set(lacking_sources "")
if(WEFT_BENCH_LACKING)
  file(STRINGS ${CMAKE_SOURCE_DIR}/shaders/shared/effects.glsl lacks REGEX "^#ifdef WEFT_LACKS_")
  list(TRANSFORM lacks REPLACE "^#ifdef " "")
  foreach(source ${shader_sources})
    if(source MATCHES "/integrate(_bands|_steal|_strip|_texel)?\\.comp$")
      foreach(macro ${lacks})
        list(APPEND lacking_sources ${source}+${macro})
      endforeach()
    endif()
  endforeach()
endif()

foreach(variant ${shader_sources} ${double_sources} ${reach_sources} ${spread_sources} ${texel_sources} ${lacking_sources})
  string(REGEX REPLACE "\\+.*" "" source ${variant})
  set(define "")
  if(variant MATCHES "\\+(.*)$")
    string(REPLACE "+" ";-D" define -D${CMAKE_MATCH_1})
  endif()
  file(RELATIVE_PATH name ${CMAKE_SOURCE_DIR}/shaders ${variant})
  set(output ${spirv_dir}/${name}.spv)
  get_filename_component(folder ${output} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(OUTPUT ${output}
    COMMAND ${GLSLC} ${define} --target-env=vulkan1.3 -O -Werror -MD -MF ${output}.d -o ${output} ${source}
    COMMAND $<IF:$<BOOL:${SPIRV_VAL}>,${SPIRV_VAL},true> $<$<BOOL:${SPIRV_VAL}>:--scalar-block-layout>
      $<$<BOOL:${SPIRV_VAL}>:--target-env> $<$<BOOL:${SPIRV_VAL}>:vulkan1.3> ${output}
    DEPENDS ${source} DEPFILE ${output}.d COMMENT "glslc ${name}" VERBATIM COMMAND_EXPAND_LISTS)
  list(APPEND spirv_files ${output})
  list(APPEND spirv_names ${name})
endforeach()

set(embedded ${CMAKE_BINARY_DIR}/spirv/embedded.cpp)
string(JOIN "," names ${spirv_names})
add_custom_command(OUTPUT ${embedded}
  COMMAND ${CMAKE_COMMAND} -DDIR=${spirv_dir} -DNAMES=${names} -DOUT=${embedded} -P ${CMAKE_SOURCE_DIR}/cmake/EmbedSpirv.cmake
  DEPENDS ${spirv_files} ${CMAKE_SOURCE_DIR}/cmake/EmbedSpirv.cmake COMMENT "embedding SPIR-V" VERBATIM)
add_library(weft_spirv STATIC ${embedded})
target_include_directories(weft_spirv PUBLIC ${CMAKE_SOURCE_DIR}/cmake)
