from types import SimpleNamespace


class SkinCellLedColor(SimpleNamespace):
    pass


class SkinCellDataArray(SimpleNamespace):
    pass
