# OpenGL and EGL loaders, generated at configure time from the specifications that the distribution's glad carries.
# --reproducible keeps the generator off the network.
set(FIRN_GLAD_DIR ${PROJECT_BINARY_DIR}/glad)
set(FIRN_GLAD_API "gl:core=4.6,egl=1.5")
set(FIRN_GLAD_EXTENSIONS GL_KHR_debug GL_KHR_parallel_shader_compile GL_NV_shader_atomic_float
  EGL_EXT_device_base EGL_EXT_device_enumeration EGL_EXT_device_query EGL_EXT_platform_base
  EGL_EXT_platform_device EGL_KHR_surfaceless_context EGL_MESA_platform_surfaceless)
string(REPLACE ";" "," FIRN_GLAD_EXTENSIONS "${FIRN_GLAD_EXTENSIONS}")

if(NOT EXISTS ${FIRN_GLAD_DIR}/src/gl.c OR NOT EXISTS ${FIRN_GLAD_DIR}/src/egl.c)
  find_program(FIRN_GLAD glad REQUIRED DOC "The glad 2 loader generator (Debian: python3-glad)")
  execute_process(
    COMMAND ${FIRN_GLAD} --quiet --reproducible --api ${FIRN_GLAD_API} --extensions ${FIRN_GLAD_EXTENSIONS}
      --out-path ${FIRN_GLAD_DIR} c --loader
    RESULT_VARIABLE result ERROR_VARIABLE messages OUTPUT_QUIET)
  if(NOT result EQUAL 0)
    file(REMOVE_RECURSE ${FIRN_GLAD_DIR})
    message(FATAL_ERROR "glad could not generate the OpenGL loader:\n${messages}")
  endif()
endif()

add_library(glad STATIC ${FIRN_GLAD_DIR}/src/gl.c ${FIRN_GLAD_DIR}/src/egl.c)
target_include_directories(glad SYSTEM PUBLIC ${FIRN_GLAD_DIR}/include)
target_link_libraries(glad PRIVATE ${CMAKE_DL_LIBS})
