"""Stands for ParaView's module where only VTK is there."""
