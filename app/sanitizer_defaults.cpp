// Only in builds with the address sanitizer: graphics drivers, GStreamer (whose memory is GLib's), PulseAudio and D-Bus
// are loaded for as long as the program runs and leave behind what they allocate once. They must stay loaded to have
// names in the leak report, and only they are excused.

extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
    return "leak:_dri.so\nleak:libGLEW\nleak:libGLX\nleak:libLLVM\nleak:libglib-2.0\nleak:libpulse\nleak:libdbus-1\n";
}

extern "C" int dlclose(void*) {
    return 0;
}
