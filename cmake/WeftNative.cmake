# One kernel file a vector width, each compiled for its instructions alone. They stand by themselves: joined
# with others, or sharing inline functions with them, they would carry their instructions elsewhere.
foreach(width v2 v3 v4 plain)
  set(source ${CMAKE_SOURCE_DIR}/src/native/kernel_${width}.cpp)
  set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(NOT width STREQUAL plain AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set_source_files_properties(${source} PROPERTIES
      COMPILE_OPTIONS "-march=x86-64-${width}" COMPILE_DEFINITIONS WEFT_KERNELS_X86)
  endif()
endforeach()
