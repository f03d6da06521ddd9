# How each dependency is found. Versions, licences and reasons: third_party/README.md.
find_package(Threads REQUIRED)
find_package(Vulkan REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(glfw3 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
find_program(GLSLC glslc REQUIRED)
find_program(SPIRV_VAL spirv-val)

# Debian's shaderc links only with its parts named one by one.
add_library(weft_shaderc INTERFACE)
target_link_libraries(weft_shaderc INTERFACE shaderc_combined glslang MachineIndependent GenericCodeGen OGLCompiler
  OSDependent SPIRV SPIRV-Tools-opt SPIRV-Tools Threads::Threads)

# libimgui.a holds the GLFW and Vulkan backends; they need both libraries behind them.
add_library(weft_imgui INTERFACE)
target_link_libraries(weft_imgui INTERFACE PkgConfig::IMGUI glfw Vulkan::Vulkan)

find_path(TINYOBJ_INCLUDE tiny_obj_loader.h REQUIRED)
find_path(STB_INCLUDE stb_image_write.h PATH_SUFFIXES stb REQUIRED)
add_library(weft_stb INTERFACE)
target_include_directories(weft_stb SYSTEM INTERFACE ${STB_INCLUDE})

if(WEFT_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
endif()
