# Between the encoder and an input, and between two inputs.
. "$SPECS/../encoding.bash"
embeds "\\003\\000\\000\\000$row$row"
sed -i 's/^input/input y : f32[3] by net;\ninput/' t.etl
embeds "$dimension$row$row$references"
