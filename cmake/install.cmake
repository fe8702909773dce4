# What `cmake --install` puts where; the program finds the module and the standard library from its own place.
install(TARGETS vts vts_lib
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS vts_oiio vts_geotiff vts_embree vts_freetype vts_mesh
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/vts
  RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/vts)
foreach(folder stdlib examples)
  if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/${folder})
    install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/vts)
  endif()
endforeach()
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
