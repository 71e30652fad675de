#pragma once

class QCoreApplication;

namespace skincal {

/// From now on texts that count (tr() with %n) say "1 module" and "2 modules". The texts in the source are English, but
/// only a translation has a form for one and another for many; this one is part of the program. A translation into
/// another language that is installed later goes before it.
void installPluralForms(QCoreApplication& application);

}  // namespace skincal
